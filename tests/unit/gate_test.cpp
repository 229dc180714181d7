// What the command gate lets pass: its limits, where they begin, and which it takes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/gate_bench.hpp"

namespace s4tp::gate {
namespace {

// GATE-001 to GATE-010: bit i of the violations is GATE-(i + 1), and a command not given asks for nothing.
TEST(Gate, NumbersItsLimits) {
  const Violations all[] = {
      kAccelerationLimited, kBrakingLimited, kJerkLimited, kSteeringLimited, kSteeringRateLimited,
      kLateralLimited,      kSpeedLimited,   kMotionStale, kDenied,          kNotFinite};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(all[i], 1 << i);
  EXPECT_EQ(Command{}.acceleration_mps2, 0.0F);
  EXPECT_EQ(Command{}.steering_rad, 0.0F);
}

// GATE-001: 3.5 m/s^2 of drive pass as they are, a little more does not.
TEST(Gate, LimitsDrive) {
  Bench bench;
  EXPECT_EQ(bench.settle({3.5F, 0.0F}).acceleration_mps2, 3.5F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_EQ(bench.ask({3.51F, 0.0F}).acceleration_mps2, 3.5F);
  EXPECT_EQ(bench.violations, kAccelerationLimited);
}

// GATE-002: 9 m/s^2 of braking pass at once, a little more does not.
TEST(Gate, LimitsBraking) {
  Bench bench;
  EXPECT_EQ(bench.ask({-9.0F, 0.0F}).acceleration_mps2, -9.0F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_EQ(bench.ask({-9.01F, 0.0F}).acceleration_mps2, -9.0F);
  EXPECT_EQ(bench.violations, kBrakingLimited);
}

// GATE-003: 20 m/s^3 * 0.01 s = 0.2 m/s^2 a tick upwards; downwards no limit.
TEST(Gate, LimitsRiseOfAccelerationOnly) {
  Bench bench;
  (void)bench.settle({0.0F, 0.0F});
  EXPECT_FLOAT_EQ(bench.ask({1.0F, 0.0F}).acceleration_mps2, 0.2F);
  EXPECT_EQ(bench.violations, kJerkLimited);
  EXPECT_FLOAT_EQ(bench.ask({0.39F, 0.0F}).acceleration_mps2, 0.39F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_EQ(bench.ask({-8.0F, 0.0F}).acceleration_mps2, -8.0F);
  EXPECT_FLOAT_EQ(bench.ask({0.0F, 0.0F}).acceleration_mps2, -7.8F);
}

// GATE-004: 0.55 rad to either side.
TEST(Gate, LimitsSteeringAngle) {
  Bench bench;
  EXPECT_EQ(bench.settle({0.0F, 0.55F}, 1.0F).steering_rad, 0.55F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_EQ(bench.ask({0.0F, 0.56F}, 1.0F).steering_rad, 0.55F);
  EXPECT_EQ(bench.violations, kSteeringLimited);
  EXPECT_EQ(bench.settle({0.0F, -0.7F}, 1.0F).steering_rad, -0.55F);
  EXPECT_EQ(bench.violations, kSteeringLimited);
}

// GATE-005: 0.7 rad/s * 0.01 s = 0.007 rad a tick.
TEST(Gate, LimitsSteeringRate) {
  Bench bench;
  EXPECT_FLOAT_EQ(bench.ask({0.0F, 0.0069F}).steering_rad, 0.0069F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_FLOAT_EQ(bench.ask({0.0F, 0.1F}).steering_rad, 0.0139F);
  EXPECT_EQ(bench.violations, kSteeringRateLimited);
  EXPECT_FLOAT_EQ(bench.ask({0.0F, -0.1F}).steering_rad, 0.0069F);
  EXPECT_EQ(bench.violations, kSteeringRateLimited);
}

// GATE-006: at 15 m/s 6 m/s^2 allow atan(6 * 2.9 / 225) = 0.0772 rad; the bound is never above, at most 2 %
// below.
TEST(Gate, LimitsLateralAcceleration) {
  for (const float speed_mps : {6.0F, 8.0F, 10.0F, 15.0F, 25.0F, 40.0F}) {
    Bench bench;
    const double steering_rad = bench.settle({0.0F, 0.5F}, speed_mps).steering_rad;
    const double lateral_mps2 = double{speed_mps} * speed_mps * std::tan(steering_rad) / 2.9;
    EXPECT_LE(lateral_mps2, 6.0 + 1e-4) << speed_mps;
    if (double{speed_mps} * speed_mps * std::tan(0.5) / 2.9 > 6.0) {
      EXPECT_GE(lateral_mps2, 5.85) << speed_mps;
      EXPECT_NE(bench.violations & kLateralLimited, 0);
    } else {
      EXPECT_NEAR(steering_rad, 0.5, 1e-6);
    }
  }
  // To the right as to the left.
  Bench left;
  Bench right;
  EXPECT_EQ(left.settle({0.0F, 0.5F}, 15.0F).steering_rad, -right.settle({0.0F, -0.5F}, 15.0F).steering_rad);
}

// GATE-006: at 15 m/s m = 6 * 2.9 / 225 = 0.077333, and 3 m / (3 + m^2) = 0.077179 rad.
TEST(Gate, LateralBoundByHand) {
  Bench bench;
  EXPECT_NEAR(bench.settle({0.0F, 0.5F}, 15.0F).steering_rad, 0.077179F, 1e-6F);
}

// GATE-006: a car that steers up to 0.8 rad. At 2.56 m/s m = 17.4 / 6.5536 = 2.655, beyond the top of 3 m /
// (3 + m^2) at sqrt(3): all 0.8 rad, though the formula would give 0.793. At 4.8 m/s m = 17.4 / 23.04 =
// 0.7552: 0.6346 rad.
TEST(Gate, LateralBoundOfAWideSteering) {
  Limits limits;
  limits.steering_max_rad = 0.8F;
  Bench slow(limits);
  EXPECT_EQ(slow.settle({0.0F, 0.8F}, 2.56F).steering_rad, 0.8F);
  Bench faster(limits);
  EXPECT_NEAR(faster.settle({0.0F, 0.8F}, 4.8F).steering_rad, 0.6346F, 1e-4F);
}

// GATE-005 before GATE-006: turning in at 5 m/s, then suddenly 20 m/s: the steering goes back 0.007 rad a
// tick.
TEST(Gate, SteersBackAtTheRateWhenTheSpeedJumps) {
  Bench bench;
  (void)bench.settle({0.0F, 0.4F}, 5.0F);
  EXPECT_NEAR(bench.ask({0.0F, 0.4F}, 20.0F).steering_rad, 0.393F, 1e-6F);
  EXPECT_EQ(bench.violations, kLateralLimited | kSteeringRateLimited);
}

// GATE-007: at 40 m/s drive passes, a bit faster it does not, braking always does.
TEST(Gate, NoDriveAboveTopSpeed) {
  Bench bench;
  EXPECT_EQ(bench.settle({1.0F, 0.0F}, 40.0F).acceleration_mps2, 1.0F);
  EXPECT_EQ(bench.violations, 0);
  EXPECT_EQ(bench.ask({1.0F, 0.0F}, 40.01F).acceleration_mps2, 0.0F);
  EXPECT_EQ(bench.violations, kSpeedLimited);
  EXPECT_EQ(bench.ask({-2.0F, 0.0F}, 60.0F).acceleration_mps2, -2.0F);
  EXPECT_EQ(bench.violations, 0);
}

// GATE-012: taking over at 0.3 rad and -2 m/s^2 goes on from there: next at most 0.307 rad and -1.8 m/s^2.
TEST(Gate, TakesOverFromWhatIsThere) {
  Bench bench;
  bench.motion(5.0F, -2.0F);
  bench.gate.reset(0.3F);
  Command command{1.0F, 0.5F};
  EXPECT_EQ(bench.gate.apply(true, command), kJerkLimited | kSteeringRateLimited);
  EXPECT_FLOAT_EQ(command.acceleration_mps2, -1.8F);
  EXPECT_FLOAT_EQ(command.steering_rad, 0.307F);
  bench.gate.reset(std::numeric_limits<float>::quiet_NaN());
  bench.motion(5.0F);
  command = {};
  (void)bench.gate.apply(true, command);
  EXPECT_EQ(command.steering_rad, 0.0F);
}

// GATE-012: taking over before any motion frame counts from 0: with the first one 0.2 m/s^2 are let through.
TEST(Gate, TakesOverFromRestUnheard) {
  Bench bench;
  bench.gate.reset(0.0F);
  EXPECT_FLOAT_EQ(bench.ask({1.0F, 0.0F}).acceleration_mps2, 0.2F);
  Bench fresh;  // never reset at all
  EXPECT_FLOAT_EQ(fresh.ask({1.0F, 0.1F}).acceleration_mps2, 0.2F);
}

// GATE-013: each limit may be what it is on some road vehicle, to the last bit; anything else, or NaN,
// changes nothing.
TEST(Gate, TakesLimitsOfRoadVehiclesOnly) {
  const struct {
    float Limits::*limit;
    float least;
    float most;
  } ranges[] = {{&Limits::acceleration_max_mps2, 0.5F, 8.0F},
                {&Limits::braking_max_mps2, 3.0F, 12.0F},
                {&Limits::jerk_up_max_mps3, 5.0F, 50.0F},
                {&Limits::steering_max_rad, 0.1F, 0.8F},
                {&Limits::steering_rate_max_radps, 0.05F, 2.5F},
                {&Limits::lateral_acceleration_max_mps2, 1.0F, 9.0F},
                {&Limits::wheelbase_m, 1.0F, 8.0F},
                {&Limits::speed_max_mps, 5.0F, 60.0F},
                {&Limits::gentle_braking_mps2, 1.0F, 5.0F}};
  CommandGate gate{Limits{}};
  const auto takes = [&gate](float Limits::*limit, float value) {
    Limits limits;
    limits.*limit = value;
    return gate.set_limits(limits);
  };
  for (const auto& range : ranges) {
    EXPECT_TRUE(takes(range.limit, range.least));
    EXPECT_TRUE(takes(range.limit, range.most));
    EXPECT_FALSE(takes(range.limit, std::nextafter(range.least, -1.0F)));
    EXPECT_FALSE(takes(range.limit, std::nextafter(range.most, 100.0F)));
    EXPECT_FALSE(takes(range.limit, std::numeric_limits<float>::quiet_NaN()));
  }
  Limits patient;
  patient.motion_age_max_ticks = 20;
  EXPECT_TRUE(gate.set_limits(patient));
  patient.motion_age_max_ticks = 21;
  EXPECT_FALSE(gate.set_limits(patient));
}

// GATE-013: the limits of 2 m/s^2 hold from the next command on, and 9 m/s^2, refused, leave them in force.
TEST(Gate, NewLimitsHoldAtOnce) {
  Bench bench;
  Limits weak;
  weak.acceleration_max_mps2 = 2.0F;
  ASSERT_TRUE(bench.gate.set_limits(weak));
  EXPECT_EQ(bench.settle({3.0F, 0.0F}).acceleration_mps2, 2.0F);
  Limits absurd;
  absurd.acceleration_max_mps2 = 9.0F;
  ASSERT_FALSE(bench.gate.set_limits(absurd));
  EXPECT_EQ(bench.settle({3.0F, 0.0F}).acceleration_mps2, 2.0F);
}

}  // namespace
}  // namespace s4tp::gate
