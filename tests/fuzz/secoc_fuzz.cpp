// Two authentic ends and a stranger between them who loses, repeats, exchanges, changes, records and invents frames, and
// restarts an end. What comes out at the ECU is what the world said, group by group, in its order, never twice; and once
// the stranger is gone both ways work again.

#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/secoc/authentic_can.hpp"
#include "firmware/secoc/frames.hpp"
#include "firmware/wire/lane_map.hpp"
#include "hal/linux/mbedtls_authenticator.hpp"
#include "tests/fuzz/frames.hpp"
#include "tests/support/wire_samples.hpp"

using namespace s4tp;
using fuzz::expect;
using fuzz::Input;

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

std::string text_of(const hal::CanFrame& frame) {
  std::string text(1, static_cast<char>(frame.id));
  text.append(reinterpret_cast<const char*>(frame.data), 8);
  return text;
}

struct Bus {
  Bus() {
    restart_ecu();
    restart_world();
    map.update(wire::sample_map(3, 2, 2));
  }
  void restart_ecu() { ecu.emplace(ecu_port, ecu_keys, secoc::End::kEcu); }
  void restart_world() { world.emplace(world_port, world_keys, secoc::End::kWorld); }

  void send(const wire::Frame& frame) {
    said.insert(text_of(to_hal(frame)));
    expect(world->send(to_hal(frame)), "the bus takes all");
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
    commanded.insert(text_of(to_hal(frame)));
    expect(ecu->send(to_hal(frame)), "the bus takes all");
  }
  /// What the ECU's application gets.
  void take() {
    motion_came = false;
    int pending_number = -1;
    for (hal::CanFrame frame; ecu->receive(frame);) {
      secoc::Group group{};
      if (secoc::find_group(frame.id, group))
        expect(said.count(text_of(frame)) == 1, "what comes out was said by the world");
      wire::Frame of_wire{frame.id, 8, {}};
      for (int i = 0; i < 8; ++i) of_wire.data[i] = frame.data[i];
      wire::Motion message;
      wire::Steering angle;
      if (wire::decode(of_wire, message)) {
        expect(message.vehicle_time_ms > newest, "newer than all before");
        newest = pending_number = message.vehicle_time_ms;
        motion_came = true;
      } else if (wire::decode(of_wire, angle)) {
        const int own = static_cast<int>(angle.steering_rad * 10000.0F + 0.5F);
        expect(own == pending_number % 30000, "of one group");
      }
    }
  }
  /// \return whether a command came
  bool world_takes() {
    bool came = false;
    for (hal::CanFrame frame; world->receive(frame);) {
      if (frame.id != wire::kCommandId) continue;
      expect(commanded.count(text_of(frame)) == 1, "a command that comes out was made by the ECU");
      commanded.erase(text_of(frame));
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
  std::set<std::string> said;
  std::set<std::string> commanded;  ///< and not yet taken
  std::vector<hal::CanFrame> recorded;
  int number = 0;
  int commands = 0;
  int newest = -1;
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
    default:
      frames[at].data[input.below(8)] = input.byte();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const auto bus = std::make_unique<Bus>();
  fuzz::Counters counters;
  for (int steps = 0; !input.empty() && steps < 300; ++steps) {
    switch (input.below(12)) {
      case 0:
        meddle(input, bus->world_port.out);
        break;
      case 1:
        meddle(input, bus->ecu_port.out);
        break;
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
      default:
        bus->world_tick();
        bus->deliver();
        bus->ecu_tick();
        static_cast<void>(bus->world_takes());
        bus->deliver();
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
