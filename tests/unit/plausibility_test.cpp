#include "firmware/ecu/plausibility.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plausibility_drive.hpp"

namespace s4tp::ecu {
namespace {

// Row i of the limits is check i, and each has a bit of its sender.
TEST(Plausibility, OneRowForEachCheck) {
  for (int i = 0; i < kCheckCount; ++i) {
    EXPECT_EQ(static_cast<int>(plausibility_limit(i).check), i);
    EXPECT_NE(bit(plausibility_limit(i).fault) & ~0xFFFFU, 0U);
    EXPECT_GT(plausibility_limit(i).base, 0.0F);
    EXPECT_GT(plausibility_limit(i).ticks, 0);
  }
}

// PLAUS-001: 13 m/s^2, 0.62 rad of steering or 1.3 rad/s at 10 m/s is no car; two ticks of it are a fault.
TEST(Plausibility, BeyondPhysics) {
  EXPECT_EQ(ticks_until(Check::kRange, [](float, Measured& told) { told.acceleration_mps2 = -13.0F; }), 2);
  EXPECT_EQ(ticks_until(Check::kRange, [](float, Measured& told) { told.steering_rad = 0.62F; }), 2);
  EXPECT_EQ(ticks_until(Check::kRange, [](float, Measured& told) { told.yaw_rate_radps = 1.3F; }), 2);
  EXPECT_EQ(ticks_until(Check::kRange, [](float, Measured& told) { told.speed_mps = 71.0F; }), 2);
  EXPECT_EQ(ticks_until(Check::kRange, [](float, Measured& told) { told.acceleration_mps2 = -11.0F; }), -1);
}

// PLAUS-002: 20 m/s^2 told at constant speed sum up to 1.3 m/s in 7 ticks; 1 m/s^2 (a slope of 10 %) never
// do.
TEST(Plausibility, SpeedAgainstAcceleration) {
  const auto told_by = [](float offset_mps2) {
    return [offset_mps2](float, Measured& told) { told.acceleration_mps2 += offset_mps2; };
  };
  const int ticks = ticks_until(Check::kSpeedAcceleration, told_by(20.0F));
  EXPECT_GE(ticks, 7);
  EXPECT_LE(ticks, 9);
  EXPECT_EQ(ticks_until(Check::kSpeedAcceleration, told_by(1.0F)), -1);
  const auto jump = [](float, Measured& told) { told.speed_mps -= 2.0F; };
  EXPECT_EQ(ticks_until(Check::kSpeedAcceleration, jump), 2);
}

// PLAUS-003 PLAUS-004: 1.4 m at once is seen by the second pose, 1 m/s within 2.5 s; 0.4 m at once and
// 0.25 m/s are below what odometry can tell at 10 m/s.
TEST(Plausibility, PoseAgainstReckoning) {
  const auto ahead = [](float rate_mps, float jump_m) {
    return [=](float since_s, Measured& told) { told.rear_axle.x_m += jump_m + rate_mps * since_s; };
  };
  const auto left = [](float rate_mps, float jump_m) {
    return [=](float since_s, Measured& told) { told.rear_axle.y_m += jump_m + rate_mps * since_s; };
  };
  EXPECT_LE(ticks_until(Check::kPoseAlong, ahead(0.0F, 1.4F)), 6);
  EXPECT_LE(ticks_until(Check::kPoseAcross, left(0.0F, 1.4F)), 6);
  for (const int ticks : {ticks_until(Check::kPoseAlong, ahead(1.0F, 0.0F)),
                          ticks_until(Check::kPoseAcross, left(1.0F, 0.0F))}) {
    EXPECT_GT(ticks, 0);
    EXPECT_LE(ticks, 250);
  }
  EXPECT_EQ(ticks_until(Check::kPoseAlong, ahead(0.25F, 0.0F)), -1);
  EXPECT_EQ(ticks_until(Check::kPoseAcross, left(0.25F, 0.0F)), -1);
  EXPECT_EQ(ticks_until(Check::kPoseAlong, ahead(0.0F, 0.4F)), -1);
  EXPECT_EQ(ticks_until(Check::kPoseAcross, left(0.0F, 0.4F)), -1);
}

// PLAUS-005: a heading that turns by 0.05 rad/s while the yaw rate is 0; 0.015 rad/s may be a gyroscope's.
TEST(Plausibility, HeadingAgainstYawRate) {
  const auto turning = [](float rate_radps) {
    return [=](float since_s, Measured& told) { told.rear_axle.heading_rad += rate_radps * since_s; };
  };
  const int ticks = ticks_until(Check::kPoseHeading, turning(0.05F));
  EXPECT_GT(ticks, 50);
  EXPECT_LE(ticks, 150);
  EXPECT_EQ(ticks_until(Check::kPoseHeading, turning(0.015F)), -1);
}

// PLAUS-003: a speed told 5 % too high from the start on makes the pose fall behind; 3 % may be worn tyres.
TEST(Plausibility, ScaledSpeed) {
  for (const float scale : {1.05F, 0.95F, 1.03F, 0.97F}) {
    Drive drive;
    const int ticks =
        drive.until(Check::kPoseAlong, [scale](float, Measured& told) { told.speed_mps *= scale; });
    EXPECT_EQ(ticks > 0, std::abs(scale - 1.0F) > 0.04F) << scale;
  }
}

// PLAUS-002 PLAUS-003: at 0.9 of 10 m/s there is no step to be seen, 1 m/s of 1.3, but the pose runs ahead by 1 m/s, to
// 2 m * (1 - exp(-t / 2 s)): more than 0.86 m after 1.1 s, and four ticks later a fault.
TEST(Plausibility, SpeedAtNineTenths) {
  Drive drive;
  drive.honest(100);
  const int ticks = drive.until(Check::kPoseAlong, [](float, Measured& told) { told.speed_mps *= 0.9F; });
  EXPECT_GT(ticks, 110);
  EXPECT_LE(ticks, 120);
  EXPECT_EQ(drive.monitor.faults(), bit(FaultBit::kPoseImplausible));
}

// PLAUS-006: at 10 m/s and straight wheels 0.5 rad/s is no bend; 0.05 rad/s may be camber or a crooked wheel.
TEST(Plausibility, YawRateAgainstSteering) {
  const auto turning = [](float rate_radps) {
    return [=](float, Measured& told) { told.yaw_rate_radps += rate_radps; };
  };
  EXPECT_GT(ticks_until(Check::kYawSteering, turning(0.5F)), 0);
  EXPECT_LE(ticks_until(Check::kYawSteering, turning(0.5F)), 60);
  EXPECT_EQ(ticks_until(Check::kYawSteering, turning(0.05F)), -1);
  EXPECT_EQ(ticks_until(Check::kPoseHeading, turning(0.015F)), -1);
}

// PLAUS-007 PLAUS-008: wheels that do not do what they were told, 0.1 rad off, and a car that is told to
// brake with 5 m/s^2 and does not; while nothing reaches the actuators neither is a fault.
TEST(Plausibility, MeasuredAgainstCommanded) {
  const auto steering = [](float, Measured& told) { told.steering_rad = 0.1F; };
  EXPECT_EQ(ticks_until(Check::kSteeringCommand, steering), 15);
  Drive drive;
  drive.honest(100);
  drive.commanded.command.acceleration_mps2 = -5.0F;
  const int ticks = drive.until(Check::kAccelerationCommand, nullptr);
  EXPECT_GE(ticks, 50);
  EXPECT_LE(ticks, 70);
  Drive idle;
  idle.commanded.active = false;
  idle.commanded.command.acceleration_mps2 = -5.0F;
  EXPECT_EQ(idle.until(Check::kAccelerationCommand, steering), -1);
  EXPECT_FALSE(idle.monitor.failed(Check::kSteeringCommand));
}

// PLAUS-007: wheels turned as fast as the gate lets them, 0.7 rad/s, whatever they lag behind: 0.02 s or 0.15 s.
TEST(Plausibility, WheelsTurnedFastAreNoFault) {
  for (const float lag_s : {0.02F, 0.08F, 0.15F}) {
    Drive drive;
    drive.honest(100);
    float wheels_rad = 0.0F;
    for (int tick = 0; tick < 100; ++tick) {
      wheels_rad += 0.01F / lag_s * (drive.commanded.command.steering_rad - wheels_rad);
      drive.commanded.command.steering_rad += tick < 70 ? 0.007F : 0.0F;
      const auto told = [=](float, Measured& measured) { measured.steering_rad = wheels_rad; };
      drive.step(told, 0.0F);
      EXPECT_FALSE(drive.monitor.failed(Check::kSteeringCommand)) << lag_s << " s, tick " << tick;
    }
  }
}

// PLAUS-009: told to set off with 2 m/s^2 and still at 0 half a second later; held with the brake that is
// no fault.
TEST(Plausibility, SpeedFrozenAtZero) {
  for (const float asked_mps2 : {2.0F, -2.0F}) {
    Drive drive;
    drive.truth.speed_mps = 0.0F;
    drive.honest(100);
    drive.commanded.command.acceleration_mps2 = asked_mps2;
    const int ticks = drive.until(Check::kSpeedFrozen, nullptr);
    EXPECT_EQ(ticks > 0, asked_mps2 > 0.0F);
    EXPECT_LE(ticks, 50);
  }
}

// PLAUS-010: on a lane 3.2 m wide the rear axle may be 2.6 m from its centre for ever, 2.7 m for 0.2 s; 10 m
// beyond its end it is still on it. While we do not drive it may be anywhere.
TEST(Plausibility, OutsideEveryLane) {
  wire::Map map;
  wire::Lane& lane = map.lanes[7];
  lane.present = true;
  lane.point_count = 2;
  lane.width_m = 3.2F;
  lane.x_m[1] = 100.0F;
  EXPECT_FLOAT_EQ(outside_lanes_m(map, {50.0F, 1.6F}), 0.0F);
  EXPECT_NEAR(outside_lanes_m(map, {50.0F, -2.7F}), 1.1F, 1e-5F);
  EXPECT_FLOAT_EQ(outside_lanes_m(map, {109.0F, 0.0F}), 0.0F);
  EXPECT_NEAR(outside_lanes_m(map, {114.0F, 3.0F}), 3.4F, 1e-4F);  // 4 and 3 make 5, less half the width

  for (const float left_m : {2.5F, 2.7F}) {
    Drive drive;
    drive.truth.speed_mps = 0.0F;
    drive.truth.rear_axle = {50.0F, left_m, 0.0F};
    drive.map = &map;
    EXPECT_EQ(drive.until(Check::kOffMap, nullptr, 100) > 0, left_m > 2.6F);
    Drive parked;
    parked.truth = drive.truth;
    parked.map = &map;
    parked.commanded.active = false;
    EXPECT_EQ(parked.until(Check::kOffMap, nullptr, 100), -1);
  }
}

// PLAUS-012: a pose 500 m off is a fault while it lasts and for less than 5 s after.
TEST(Plausibility, ALieThatEndsIsForgotten) {
  Drive drive;
  drive.honest(100);
  const auto far = [](float, Measured& told) { told.rear_axle.y_m += 500.0F; };
  EXPECT_GT(drive.until(Check::kPoseAcross, far), 0);
  for (int i = 0; i < 100; ++i) drive.step(far, 1.0F);
  drive.honest(1);
  EXPECT_NE(drive.monitor.faults() & bit(FaultBit::kPoseImplausible), 0U);
  drive.honest(500);
  EXPECT_EQ(drive.monitor.faults(), 0U);
}

// PLAUS-012: the same, though the lie came with 1.2 rad/s at 10 m/s, which widens its limit to 3.7 m, and the
// car stands afterwards, where it is 0.3 m.
TEST(Plausibility, ALieIsForgottenThoughLimitsTighten) {
  Drive drive;
  drive.honest(100);
  const auto far = [](float, Measured& told) {
    told.rear_axle.y_m += 500.0F;
    told.yaw_rate_radps += 1.2F;
  };
  for (int i = 0; i < 20; ++i) drive.step(far, 1.0F);
  EXPECT_NE(drive.monitor.faults(), 0U);
  drive.truth.speed_mps = 0.0F;
  drive.honest(500);
  EXPECT_EQ(drive.monitor.faults(), 0U);
}

// ECU-096 ECU-097 ECU-098 ECU-099: each check raises its sender's bit, and no other. (Moving, a fast clock
// makes the pose run behind as well.)
TEST(Plausibility, EachSenderItsBit) {
  struct Case {
    FaultBit fault;
    Drive::Lie lie;
    float speed_mps = Drive::kSpeed_mps;
  };
  const Case cases[] = {
      {FaultBit::kMotionImplausible, [](float, Measured& told) { told.acceleration_mps2 = 5.0F; }},
      {FaultBit::kSteeringImplausible, [](float, Measured& told) { told.steering_rad = 0.07F; }},
      {FaultBit::kPoseImplausible, [](float, Measured& told) { told.rear_axle.y_m += 1.4F; }},
      {FaultBit::kClockImplausible, [](float, Measured& told) { told.passed_ms = 11; }, 0.0F},
  };
  for (const Case& c : cases) {
    Drive drive;
    drive.truth.speed_mps = c.speed_mps;
    drive.honest(100);
    for (int i = 1; i <= 300 && drive.monitor.faults() == 0; ++i) {
      drive.step(c.lie, 0.01F * static_cast<float>(i));
    }
    EXPECT_EQ(drive.monitor.faults(), bit(c.fault));
  }
}

}  // namespace
}  // namespace s4tp::ecu
