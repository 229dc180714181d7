#pragma once
/// A judge with an ECU in front of it that does what a test says.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "firmware/wire/e2e.hpp"
#include "sim_host/faults/judge.hpp"
#include "tests/support/sealed_frames.hpp"

namespace s4tp::faults {

inline constexpr int kSettling = 250;

/// An ECU made of nothing but frames, in front of a judge.
class Bench {
 public:
  Judge judge{kSettling};
  ecu::Mode mode = ecu::Mode::kDriving;
  ecu::Faults faults = 0;  ///< as its status says
  float acceleration_mps2 = 0.0F;
  float steering_rad = 0.0F;
  double speed_mps = 10.0;  ///< true, and told
  bool motion = true;
  bool status = true;
  bool faulty = true;  ///< the script is not over
  int number = 0;

  /// The frames of one tick.
  std::vector<wire::Frame> frames() {
    std::vector<wire::Frame> sent;
    if (status && number % 10 == 0) {
      wire::EcuStatus message;
      message.mode = static_cast<std::uint8_t>(mode);
      message.faults = faults;
      sent.push_back(test::sealed(message, status_sender_));
    }
    wire::Command command;
    command.acceleration_mps2 = acceleration_mps2;
    command.steering_rad = steering_rad;
    command.mode = static_cast<std::uint8_t>(mode);
    command.accepted = static_cast<std::uint16_t>(accepted_ & 0xFFF);
    sent.push_back(test::sealed(command, command_sender_));
    return sent;
  }

  void begin() {
    judge.begin_tick(++number, speed_mps, !faulty);
    if (!motion) return;
    wire::Motion message;
    message.speed_mps = static_cast<float>(speed_mps);
    take(test::sealed(message, motion_sender_));
  }

  void take(const wire::Frame& frame) {
    judge.taken(frame);
    ++accepted_;
  }

  Breach ticks(int count) {
    for (int i = 0; i < count; ++i) {
      begin();
      judge.control_tick(frames(), false);
      judge.end_tick();
    }
    return judge.verdict().breach;
  }

 private:
  int accepted_ = 0;
  wire::E2eSender motion_sender_;
  wire::E2eSender status_sender_;
  wire::E2eSender command_sender_;
};

/// Breach after `before` good ticks and one more with what `spoil` did.
template <class Spoil>
Verdict spoiled(const Spoil& spoil, Bench bench = {}) {
  EXPECT_EQ(bench.ticks(20), Breach::kNone) << bench.judge.verdict().what;
  spoil(bench);
  (void)bench.ticks(1);
  return bench.judge.verdict();
}

}  // namespace s4tp::faults
