// Two authentic ends and a stranger between them who loses, repeats, exchanges, changes, records and invents frames, and
// restarts an end. What comes out at the ECU is what the world said, motion groups and track lists whole, in their order,
// never twice, the map as the world sealed it, never an older one after a newer; and once the stranger is gone both ways
// work again.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/secoc/authentic_can.hpp"
#include "firmware/secoc/frames.hpp"
#include "firmware/wire/lane_map.hpp"
#include "hal/linux/mbedtls_authenticator.hpp"
#include "tests/fuzz/frames.hpp"
#include "tests/fuzz/secoc_oracles.hpp"
#include "tests/support/wire_samples.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;
using fuzz::text_of;

namespace {

/// mbedTLS; nonces are counted instead of drawn, so that an input does the same every time.
class Keys final : public hal::Authenticator {
 public:
  bool cmac(hal::KeySlot slot, const std::uint8_t* bytes, std::uint32_t size,
            std::uint8_t (&mac)[hal::kCmacBytes]) override {
    return keys_.cmac(slot, bytes, size, mac);
  }
  bool derive(hal::KeySlot slot, const std::uint8_t* bytes, std::uint32_t size) override {
    return keys_.derive(slot, bytes, size);
  }
  bool random(std::uint8_t* bytes, std::uint32_t size) override {
    ++drawn_;
    for (std::uint32_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(drawn_ >> (8U * (i % 4U)));
    return true;
  }

 private:
  hal::linux_host::MbedtlsAuthenticator keys_{hal::linux_host::AuthenticationKey{{1, 2, 3, 4}}};
  std::uint32_t drawn_ = 0;
};

/// One end's controller: what it sends lies on the bus until the stranger lets it pass.
struct Port final : hal::Can {
  bool receive(hal::CanFrame& frame) override {
    if (in.empty()) return false;
    frame = in.front();
    in.pop_front();
    return true;
  }
  bool send(const hal::CanFrame& frame) override {
    out.push_back(frame);
    return true;
  }
  hal::CanState state() const override { return hal::CanState::kActive; }
  hal::CanCounters counters() const override { return {}; }
  std::deque<hal::CanFrame> in;
  std::vector<hal::CanFrame> out;
};

struct Bus {
  Bus() {
    restart_ecu();
    restart_world();
    map.update(wire::sample_map(3, 2, 2));
  }
  void restart_ecu() { ecu.emplace(ecu_port, ecu_keys, secoc::End::kEcu); }
  void restart_world() { world.emplace(world_port, world_keys, secoc::End::kWorld); }

  void send(const wire::Frame& frame) {
    said[text_of(to_hal(frame))] = number;
    secoc::Group group{};
    if (secoc::find_group(frame.id, group)) ++frames_said[{group, number}];
    map_taken.said(to_hal(frame));
    expect(world->send(to_hal(frame)), "the bus takes all");
    if (world_port.out.back().id == wire::kMapAuthId) map_taken.sealed();
  }
  template <class Message>
  void say(const Message& message, wire::E2eSender& sender) {
    wire::Frame frame;
    expect(wire::encode(message, frame), "every value fits");
    sender.protect(frame);
    send(frame);
  }
  /// 10 ms of the world's end: what it says carries its number.
  void world_tick() {
    ++number;
    wire::Motion message;
    message.vehicle_time_ms = static_cast<std::uint16_t>(number);
    say(message, motion);
    wire::Steering angle;
    angle.steering_rad = 0.0001F * static_cast<float>(number % 30000);
    say(angle, steering);
    if (number % 10 == 4) {
      for (const wire::Frame& frame : wire::frames_of(lists, wire::sample_tracks(number % 4, number)))
        send(frame);
    }
    for (const wire::Frame& frame : wire::frames_of(map, static_cast<std::uint32_t>(10 * number), 10))
      send(frame);
    say(wire::Tick{static_cast<std::uint16_t>(number)}, tick);
  }
  void ecu_tick() {
    take();
    wire::Command message;
    message.tick = static_cast<std::uint16_t>(++commands % 4096);
    wire::Frame frame;
    expect(wire::encode(message, frame), "every value fits");
    command.protect(frame);
    commanded[text_of(to_hal(frame))] = commands;
    expect(ecu->send(to_hal(frame)), "the bus takes all");
  }
  /// What the ECU's application gets.
  void take() {
    const bool all = ecu_port.in.size() <= secoc::AuthenticCan::kLookedAt;
    motion_came = false;
    for (hal::CanFrame frame; ecu->receive(frame);) {
      secoc::Group group{};
      if (!secoc::find_group(frame.id, group)) continue;
      const auto words = said.find(text_of(frame));
      expect(words != said.end(), "what comes out was said by the world");
      if (group == secoc::Group::kMap) {
        map_taken.take(frame);
      } else {
        taken[group].take(frame, words->second, frames_said[{group, words->second}]);
      }
      motion_came = motion_came || frame.id == wire::kMotionId;
    }
    for (const auto& [group, of_group] : taken) of_group.end();
    if (all) map_taken.end();
  }
  /// \return whether a command came
  bool world_takes() {
    bool came = false;
    for (hal::CanFrame frame; world->receive(frame);) {
      if (frame.id != wire::kCommandId) continue;
      const auto words = commanded.find(text_of(frame));
      expect(words != commanded.end(), "a command that comes out was made by the ECU");
      command_taken.take(frame, words->second, 1);
      came = true;
    }
    return came;
  }

  /// All that lies on the bus goes on, both ways.
  void deliver() {
    for (const hal::CanFrame& frame : world_port.out) ecu_port.in.push_back(frame);
    for (const hal::CanFrame& frame : ecu_port.out) world_port.in.push_back(frame);
    for (const hal::CanFrame& frame : world_port.out) recorded.push_back(frame);
    for (const hal::CanFrame& frame : ecu_port.out) recorded.push_back(frame);
    world_port.out.clear();
    ecu_port.out.clear();
  }
  void inject(const hal::CanFrame& frame) {
    ecu_port.in.push_back(frame);
    world_port.in.push_back(frame);
  }

  Keys ecu_keys, world_keys;
  Port ecu_port, world_port;
  std::optional<secoc::AuthenticCan> ecu, world;
  wire::E2eSender motion, steering, tick, command;
  wire::TrackListSender lists;
  wire::MapSender map;
  std::map<std::string, int> said;       ///< by the world, and when last
  std::map<std::string, int> commanded;  ///< by the ECU, and when
  std::map<std::pair<secoc::Group, int>, int> frames_said;
  std::map<secoc::Group, fuzz::Taken> taken;
  fuzz::Taken command_taken;
  fuzz::MapTaken map_taken;
  std::vector<hal::CanFrame> recorded;
  int number = 0;
  int commands = 0;
  bool motion_came = false;
};

void meddle(Input& input, std::vector<hal::CanFrame>& frames) {
  if (frames.empty()) return;
  const std::size_t at = input.byte() % frames.size();
  const std::size_t other = input.byte() % frames.size();
  switch (input.below(4)) {
    case 0:
      frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1:
      frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), hal::CanFrame(frames[other]));
      break;
    case 2:
      std::swap(frames[at], frames[other]);
      break;
    default: {
      wire::Frame changed = to_wire(frames[at]);
      const bool protects = wire::e2e_crc_fits(changed);  // companions have no CRC
      changed.data[input.below(8)] = input.byte();
      if (protects) wire::e2e_seal(changed);
      frames[at] = to_hal(changed);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const auto bus = std::make_unique<Bus>();
  fuzz::Counters counters;
  for (int steps = 0; !input.empty() && steps < 300; ++steps) {
    switch (const int step = input.below(12)) {
      case 2:
        if (!bus->recorded.empty()) {
          const std::size_t from = input.take<std::uint16_t>() % bus->recorded.size();
          const std::size_t count = 1U + input.byte() % 16U;
          for (std::size_t i = from; i < from + count && i < bus->recorded.size(); ++i)
            bus->inject(bus->recorded[i]);
        }
        break;
      case 3: {
        const wire::Frame frame = fuzz::take_frame(input, counters);
        hal::CanFrame forged = to_hal(frame);
        forged.length = frame.length;
        bus->inject(forged);
        break;
      }
      case 4:
        if (input.below(4) == 0) bus->restart_ecu();
        if (input.below(4) == 0) bus->restart_world();
        break;
      case 5:
        bus->map.update(
            wire::sample_map(2 + input.below(4), 2 + input.below(3), input.below(4), input.byte()));
        break;
      default: {  // 10 ms; in 1 the stranger gets hold of what one of the ends says
        const int held = step == 1 ? 1 + input.below(2) : 0;
        bus->world_tick();
        if (held == 1) meddle(input, bus->world_port.out);
        bus->deliver();
        bus->ecu_tick();
        if (held == 2) meddle(input, bus->ecu_port.out);
        static_cast<void>(bus->world_takes());
        bus->deliver();
      }
    }
  }
  bool both = false;
  for (int i = 0; i < 250 && !both; ++i) {
    bus->world_tick();
    bus->deliver();
    bus->ecu_tick();
    bus->deliver();
    const bool command_came = bus->world_takes();
    both = command_came && bus->motion_came;
  }
  expect(both, "both ways work once the stranger is gone");
  return 0;
}
