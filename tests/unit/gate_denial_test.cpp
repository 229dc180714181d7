// What the command gate hears, and how it brakes where it may not let a command pass.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/gate_bench.hpp"

namespace s4tp::gate {
namespace {

// GATE-008: ten ticks without a motion frame pass, the eleventh brakes with 3 m/s^2 and holds the steering.
TEST(Gate, BrakesWithoutMotionFrames) {
  Bench bench;
  (void)bench.settle({1.0F, 0.1F});
  for (int i = 0; i < 10; ++i) {
    Command command{1.0F, 0.1F};
    EXPECT_EQ(bench.gate.apply(true, command), 0) << i;
    EXPECT_EQ(command.acceleration_mps2, 1.0F);
  }
  Command command{1.0F, 0.2F};
  EXPECT_EQ(bench.gate.apply(true, command), kMotionStale);
  EXPECT_EQ(command.acceleration_mps2, -3.0F);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.1F);
  // Harder braking passes, and the next motion frame ends it.
  command = {-6.0F, 0.2F};
  EXPECT_EQ(bench.gate.apply(true, command), kMotionStale);
  EXPECT_EQ(command.acceleration_mps2, -6.0F);
  EXPECT_FLOAT_EQ(bench.ask({-6.0F, 0.1F}).acceleration_mps2, -6.0F);
  EXPECT_EQ(bench.violations, 0);
}

// GATE-008: a gate that never heard a motion frame brakes, whatever is permitted, and for ever: 70,000 ticks
// are more than its 16 bits count.
TEST(Gate, DeniedByDefault) {
  CommandGate gate{Limits{}};
  for (int i = 0; i < 70000; ++i) {
    Command command{2.0F, 0.3F};
    ASSERT_EQ(gate.apply(true, command), kMotionStale) << i;
    ASSERT_EQ(command.acceleration_mps2, -3.0F);
    ASSERT_EQ(command.steering_rad, 0.0F);
  }
}

// GATE-008: the same when the motion frames end after one.
TEST(Gate, StaleForEver) {
  Bench bench;
  bench.motion(5.0F);
  for (int i = 0; i < 70000; ++i) {
    Command command;
    ASSERT_EQ(bench.gate.apply(true, command) & kMotionStale, i > 10 ? kMotionStale : 0) << i;
  }
}

// GATE-008: what has never been heard counts as standing still, where the steering is free: at 0.1 m/s the
// 0.001 m/s^2 of these limits would allow 0.28 rad only, and the 0.3 rad would have to be steered back.
TEST(Gate, NothingHeardIsStandstill) {
  Limits limits;
  limits.lateral_acceleration_max_mps2 = 0.001F;
  CommandGate gate(limits);
  gate.reset(0.3F);
  Command command;
  EXPECT_EQ(gate.apply(true, command), kMotionStale);
  EXPECT_EQ(command.steering_rad, 0.3F);
}

// GATE-009: not permitted means gentle braking with the steering held, however good the command.
TEST(Gate, DeniedBrakesGently) {
  Bench bench;
  (void)bench.settle({0.0F, 0.2F});
  bench.motion(5.0F);
  Command command{-8.0F, 0.21F};
  EXPECT_EQ(bench.gate.apply(false, command), kDenied);
  EXPECT_EQ(command.acceleration_mps2, -3.0F);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.2F);
}

// GATE-010: NaN or infinity in either field is treated as denied and does not come out.
TEST(Gate, TreatsNotFiniteAsDenied) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  for (const Command bad : {Command{nan, 0.0F}, Command{0.0F, nan}, Command{infinite, 0.0F},
                            Command{0.0F, -infinite}, Command{-infinite, nan}}) {
    Bench bench;
    (void)bench.settle({0.0F, 0.1F});
    const Command out = bench.ask(bad);
    EXPECT_EQ(bench.violations, kDenied | kNotFinite);
    EXPECT_EQ(out.acceleration_mps2, -3.0F);
    EXPECT_FLOAT_EQ(out.steering_rad, 0.1F);
  }
}

// GATE-010: 1e6 is the last number that counts as one; it is limited like any other.
TEST(Gate, FiniteEndsAtAMillion) {
  const float beyond = std::nextafter(1e6F, 2e6F);
  for (const float sign : {1.0F, -1.0F}) {
    Bench bench;
    (void)bench.ask({sign * 1e6F, sign * 1e6F});
    EXPECT_EQ(bench.violations & kNotFinite, 0);
    (void)bench.ask({sign * beyond, 0.0F});
    EXPECT_EQ(bench.violations & kNotFinite, kNotFinite);
    (void)bench.ask({0.0F, sign * beyond});
    EXPECT_EQ(bench.violations & kNotFinite, kNotFinite);
  }
}

// GATE-011: a repeated counter is no news, even with other contents and a sound CRC: 45 m/s are not believed.
TEST(Gate, RepeatedCounterIsNoNews) {
  Bench bench;
  const wire::Frame first = bench.frame(5.0F);
  wire::Frame second = bench.frame(45.0F);
  second.data[1] = static_cast<std::uint8_t>((second.data[1] & 0xF0U) | (first.data[1] & 0x0FU));
  wire::e2e_seal(second);
  ASSERT_NE(first.data[0] & 0x0F, second.data[0] & 0x0F);  // the CRC is no counter
  bench.gate.observe(first);
  bench.gate.observe(second);
  Command command{0.1F, 0.0F};
  EXPECT_EQ(bench.gate.apply(true, command), 0);
}

// GATE-011: a damaged, a repeated, a foreign or a truncated frame is no news: the motion goes stale as
// without it.
TEST(Gate, ReadsTheMotionFrameItself) {
  Bench bench;
  const wire::Frame once = bench.frame(5.0F);
  wire::Frame damaged = bench.frame(5.0F);
  damaged.data[4] ^= 1U;
  wire::Frame foreign = bench.frame(5.0F);
  foreign.id = wire::kMotionId + 1;
  wire::e2e_seal(foreign);
  wire::Frame truncated = bench.frame(5.0F);
  truncated.length = 7;
  wire::e2e_seal(truncated);
  bench.gate.observe(once);
  for (int i = 0; i < 11; ++i) {
    Command command;
    EXPECT_EQ(bench.gate.apply(true, command) & kMotionStale, 0) << i;
    bench.gate.observe(once);
    bench.gate.observe(damaged);
    bench.gate.observe(foreign);
    bench.gate.observe(truncated);
  }
  Command command;
  EXPECT_EQ(bench.gate.apply(true, command) & kMotionStale, kMotionStale);
}

}  // namespace
}  // namespace s4tp::gate
