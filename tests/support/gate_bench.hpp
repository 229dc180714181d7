#pragma once
/// The command gate, and a sender of motion frames for it.

#include <gtest/gtest.h>

#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::gate {

/// A gate that hears a motion frame before each command.
class Bench {
 public:
  explicit Bench(const Limits& limits = {}) : gate(limits) {}

  void motion(float speed_mps, float acceleration_mps2 = 0.0F) {
    gate.observe(frame(speed_mps, acceleration_mps2));
  }
  wire::Frame frame(float speed_mps, float acceleration_mps2 = 0.0F) {
    wire::Motion message;
    message.speed_mps = speed_mps;
    message.acceleration_mps2 = acceleration_mps2;
    wire::Frame out;
    EXPECT_TRUE(wire::encode(message, out));
    sender.protect(out);
    return out;
  }
  /// Asks at a speed the gate has just heard of.
  Command ask(Command command, float speed_mps = 5.0F) {
    motion(speed_mps);
    violations = gate.apply(true, command);
    return command;
  }
  /// Asks until rise and rate no longer matter.
  Command settle(Command command, float speed_mps = 5.0F) {
    Command out;
    for (int i = 0; i < 200; ++i) out = ask(command, speed_mps);
    return out;
  }

  CommandGate gate;
  wire::E2eSender sender;
  Violations violations = 0;
};

}  // namespace s4tp::gate
