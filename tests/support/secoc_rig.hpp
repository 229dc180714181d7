#pragma once
/// Two ends of a bus with authentication, and a stranger on it. Keys are made here, anew in each run.

#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/secoc/authentic_can.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "hal/linux/mbedtls_authenticator.hpp"
#include "hal/sim/bus.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::secoc {

/// A key of this run.
inline hal::linux_host::AuthenticationKey new_key() {
  static std::random_device device;
  hal::linux_host::AuthenticationKey key;
  for (std::uint8_t& byte : key.bytes) byte = static_cast<std::uint8_t>(device());
  return key;
}

/// mbedTLS with nonces that a test can count.
class TestKeys final : public hal::Authenticator {
 public:
  explicit TestKeys(const hal::linux_host::AuthenticationKey& key) : keys_(key) {}
  bool cmac(hal::KeySlot slot, const std::uint8_t* bytes, std::uint32_t size,
            std::uint8_t (&mac)[hal::kCmacBytes]) override {
    ++cmacs;
    return works && keys_.cmac(slot, bytes, size, mac);
  }
  bool derive(hal::KeySlot slot, const std::uint8_t* bytes, std::uint32_t size) override {
    return works && keys_.derive(slot, bytes, size);
  }
  bool random(std::uint8_t* bytes, std::uint32_t size) override {
    ++nonces;
    return works && keys_.random(bytes, size);
  }
  bool works = true;
  int nonces = 0;
  int cmacs = 0;

 private:
  hal::linux_host::MbedtlsAuthenticator keys_;
};

/// One end, which can restart.
struct BusEnd {
  BusEnd(hal::Can& with_port, const hal::linux_host::AuthenticationKey& key, End with_end)
      : port(with_port), keys(key), end(with_end) {
    restart();
  }
  void restart() { can.emplace(port, keys, end); }
  void send(const wire::Frame& frame) { (void)can->send(to_hal(frame)); }
  std::vector<wire::Frame> take() {
    std::vector<wire::Frame> frames;
    for (hal::CanFrame frame; can->receive(frame);) frames.push_back(to_wire(frame));
    return frames;
  }

  hal::Can& port;
  TestKeys keys;
  End end;
  std::optional<AuthenticCan> can;
};

/// Decides what becomes of each frame on the bus, and keeps what it has seen.
struct Wire final : hal::sim::BusFault {
  bool pass(hal::CanFrame& frame) override {
    if (!enabled) return true;
    seen.push_back(to_wire(frame));
    return !lost || !lost(seen.back());
  }
  bool enabled = true;
  std::vector<wire::Frame> seen;
  std::function<bool(const wire::Frame&)> lost;
};

class SecocRig {
 public:
  SecocRig() { bus.fault = &wire; }

  /// One period of 10 ms: the vehicle's frames, TICK, the command. \return whether the command arrived and
  /// the motion group arrived
  struct Arrived {
    bool motion = false;
    bool command = false;
  };
  Arrived tick() {
    ++number;
    for (const wire::Frame& frame : motion_group()) world.send(frame);
    put(world, wire::Tick{static_cast<std::uint16_t>(number)}, tick_sender);
    Arrived arrived;
    for (const wire::Frame& frame : ecu.take()) {
      to_ecu.push_back(frame);
      arrived.motion = arrived.motion || frame.id == wire::kMotionId;
    }
    wire::Command command;
    command.tick = static_cast<std::uint16_t>(number % 4096);
    put(ecu, command, command_sender);
    for (const wire::Frame& frame : world.take()) {
      to_world.push_back(frame);
      arrived.command = arrived.command || frame.id == wire::kCommandId;
    }
    return arrived;
  }
  /// Ticks until both ways work; -1: not within `limit`.
  int until_both_ways(int limit = 400) {
    for (int i = 0; i < limit; ++i) {
      const Arrived arrived = tick();
      if (arrived.motion && arrived.command) return i;
    }
    return -1;
  }
  /// Motion, steering and, in every second tick, pose.
  std::vector<wire::Frame> motion_group() {
    wire::Motion motion;
    motion.vehicle_time_ms = static_cast<std::uint16_t>(10 * number);
    motion.speed_mps = 5.0F;
    std::vector<wire::Frame> frames{protect(motion, motion_sender),
                                    protect(wire::Steering{}, steering_sender)};
    if (number % 2 == 0) frames.push_back(protect(wire::Pose{}, pose_sender));
    return frames;
  }
  template <class Message>
  static wire::Frame protect(const Message& message, wire::E2eSender& sender) {
    wire::Frame frame;
    (void)wire::encode(message, frame);
    sender.protect(frame);
    return frame;
  }
  template <class Message>
  static void put(BusEnd& end, const Message& message, wire::E2eSender& sender) {
    end.send(protect(message, sender));
  }
  /// A frame as a stranger on the bus sends it.
  void inject(const wire::Frame& frame) {
    wire.enabled = false;
    (void)stranger->send(to_hal(frame));
    wire.enabled = true;
  }
  /// Frames of one id that have been on the bus.
  [[nodiscard]] std::vector<wire::Frame> seen(std::uint32_t id) const {
    std::vector<wire::Frame> frames;
    for (const wire::Frame& frame : wire.seen) {
      if (frame.id == id) frames.push_back(frame);
    }
    return frames;
  }

  hal::linux_host::AuthenticationKey key = new_key();
  hal::sim::Bus bus;
  Wire wire;
  hal::sim::Bus::Port* stranger = bus.attach();
  BusEnd ecu{*bus.attach(), key, End::kEcu};
  BusEnd world{*bus.attach(), key, End::kWorld};
  wire::E2eSender motion_sender, steering_sender, pose_sender, tick_sender, command_sender;
  std::vector<wire::Frame> to_ecu;
  std::vector<wire::Frame> to_world;
  int number = 0;
};

inline bool same(const wire::Frame& a, const wire::Frame& b) {
  return a.id == b.id && a.length == b.length && std::memcmp(a.data, b.data, sizeof a.data) == 0;
}

inline int count(const std::vector<wire::Frame>& frames, std::uint32_t id) {
  int number = 0;
  for (const wire::Frame& frame : frames) number += frame.id == id ? 1 : 0;
  return number;
}

}  // namespace s4tp::secoc
