// The tracker along a plan.
#include "firmware/ecu/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/tracked_drive.hpp"

namespace s4tp::ecu {
namespace {

/// Along x: from 8 m/s with -2 m/s^2 from t = 1 to the stop at 5 s (8 + 16 = 24 m), 3 s of standing, then
/// away with 1.5 m/s^2, which is built up over half a second.
TrajectoryPoint stop_and_go(double t) {
  TrajectoryPoint point;
  double s = 8.0 * std::min(t, 1.0);
  double v = 8.0;
  double a = 0.0;
  if (t > 1.0) {
    const double braking = std::min(t - 1.0, 4.0);
    s += 8.0 * braking - braking * braking;
    v = 8.0 - 2.0 * braking;
    a = t < 5.0 ? -2.0 : 0.0;
  }
  if (t > 8.0) {
    const double going = t - 8.0;
    const double rising = std::min(going, 0.5);
    a = 3.0 * rising;
    v = 1.5 * rising * rising;
    s += 0.5 * rising * rising * rising;
    if (going > 0.5) {
      s += v * (going - 0.5) + 0.75 * (going - 0.5) * (going - 0.5);
      v += 1.5 * (going - 0.5);
    }
  }
  point.rear_axle.x_m = static_cast<float>(s);
  point.speed_mps = static_cast<float>(v);
  point.acceleration_mps2 = static_cast<float>(a);
  return point;
}

// On a straight at walking pace, in town and fast, starting 0.4 m beside and 0.05 rad turned: back within 5
// cm after 6 s, without swinging further than 12 cm to the other side.
TEST(Tracker, ReturnsToAStraight) {
  for (const double speed_mps : {2.0, 5.0, 13.9, 25.0}) {
    TrackedDrive drive(straight(speed_mps));
    drive.plant.speed_mps = speed_mps;
    drive.plant.y_m = 0.4;
    drive.plant.heading_rad = 0.05;
    double lowest_m = 0.0;
    for (int i = 0; i < 60; ++i) {
      drive.run(0.1);
      lowest_m = std::min(lowest_m, drive.plant.y_m);
    }
    EXPECT_GT(lowest_m, -0.12) << speed_mps;
    EXPECT_NEAR(drive.plant.y_m, 0.0, 0.05) << speed_mps;
    EXPECT_NEAR(drive.plant.heading_rad, 0.0, 0.02) << speed_mps;
  }
}

// The left turn of the scenario: 10.7 m radius at 5 m/s stays within 0.3 m.
TEST(Tracker, FollowsTheLeftTurn) {
  TrackedDrive drive(left_turn(5.0));
  drive.plant.speed_mps = 5.0;
  drive.run(7.0);
  EXPECT_LT(drive.worst_cross_m, 0.3F);
  EXPECT_LT(drive.worst_cross_m, 0.08F) << "not the limit, but what it does";
  EXPECT_NEAR(drive.plant.heading_rad, 1.5708, 0.02);
}

// The same with actuators half as slow again as the controller believes.
TEST(Tracker, FollowsTheLeftTurnWithSlowActuators) {
  TrackedDrive drive(left_turn(5.0));
  drive.plant.speed_mps = 5.0;
  drive.plant.steering_lag_s = 0.15;
  drive.plant.drive_lag_s = 0.25;
  drive.run(7.0);
  EXPECT_LT(drive.worst_cross_m, 0.3F);
}

// On the ring of 200 m radius at 14 m/s (about 1 m/s^2) a car whose rear axle slips 0.0083 rad per m/s^2
// points 0.008 rad inwards. A controller that knows stays within 5 cm; one that does not would be 2 w 0.008 =
// 0.18 m off (w = 11 m).
TEST(Tracker, KnowsThatTheRearAxleSlips) {
  const DriveScript ring = [](double t) {
    TrajectoryPoint point;
    const double turned = 14.0 * t / 200.0;
    point.rear_axle = {static_cast<float>(200.0 * std::sin(turned)),
                       static_cast<float>(200.0 * (1.0 - std::cos(turned))),
                       static_cast<float>(std::remainder(turned, 6.283185307179586))};
    point.speed_mps = 14.0F;
    point.curvature_1pm = 1.0F / 200.0F;
    return point;
  };
  double cross_m[2] = {};
  for (const int knows : {0, 1}) {
    TrackedDrive drive(ring);
    drive.parameters.tracking.rear_slip = knows != 0 ? 0.0083F : 0.0F;
    drive.plant.rear_slip = 0.0083;
    drive.plant.speed_mps = 14.0;
    drive.run(5.0);
    cross_m[knows] = static_cast<double>(drive.tracker.error().cross_m);
  }
  EXPECT_NEAR(cross_m[1], 0.0, 0.05);
  EXPECT_GT(std::abs(cross_m[0]), 0.07);
}

// A car 1 m late on the turn asks for the steering of the place where it is, plan after plan: at each new
// plan's first tick the steering asked for changes by less than the gate lets pass in a tick (0.007 rad).
TEST(Tracker, LateIsNotBeside) {
  const DriveScript script = left_turn(5.0);
  TrackedDrive drive([&script](double t) { return script(t + 0.2); });
  drive.parameters.tracking.station_gain = 0.0F;  // stays late
  drive.plant.speed_mps = 5.0;
  drive.run(2.5);
  EXPECT_NEAR(drive.tracker.error().along_m, -1.0, 0.15);
  drive.forget();
  float worst_rad = 0.0F;
  for (int i = 0; i < 200; ++i) {
    const float before_rad = drive.command.steering_rad;
    drive.run(0.01);
    worst_rad = std::max(worst_rad, std::abs(drive.command.steering_rad - before_rad));
  }
  EXPECT_LT(worst_rad, 0.007F);
}

// Braking to a stop at 24 m: the car stands within 0.3 m of it and does not creep for 3 s.
TEST(Tracker, StopsWhereThePlanStops) {
  TrackedDrive drive(stop_and_go);
  drive.plant.speed_mps = 8.0;
  drive.run(6.5);
  EXPECT_EQ(drive.plant.speed_mps, 0.0);
  EXPECT_NEAR(drive.plant.x_m, 24.0, 0.3);
  const double stopped_m = drive.plant.x_m;
  drive.run(1.0);
  EXPECT_EQ(drive.plant.x_m, stopped_m);
  EXPECT_EQ(drive.command.acceleration_mps2, -drive.parameters.tracking.hold_braking_mps2);
}

// ECU-050: away from the stop: the command rises by at most 10 m/s^3 from -1 through 0, and the car is with
// the plan again, within 0.3 m and 0.3 m/s, 2.5 s later.
TEST(Tracker, RestartsWithoutJerk) {
  TrackedDrive drive(stop_and_go);
  drive.plant.speed_mps = 8.0;
  drive.run(7.0);
  ASSERT_EQ(drive.plant.speed_mps, 0.0);
  drive.forget();
  drive.run(3.5);
  EXPECT_LE(drive.worst_rise_mps3, 10.01F);
  EXPECT_GT(drive.plant.speed_mps, 1.0);
  EXPECT_NEAR(drive.plant.x_m, static_cast<double>(stop_and_go(10.5).rear_axle.x_m), 0.3);
  EXPECT_NEAR(drive.plant.speed_mps, static_cast<double>(stop_and_go(10.5).speed_mps), 0.3);
}

// A slope of 1 m/s^2 that the controller does not know of: 12 s later the integrator carries it, within 0.15
// m.
TEST(Tracker, LearnsASlope) {
  TrackedDrive drive(straight(10.0));
  drive.plant.speed_mps = 10.0;
  drive.plant.drag_mps2 = 0.8;
  drive.run(20.0);
  EXPECT_NEAR(drive.tracker.error().along_m, 0.0, 0.15);
  EXPECT_NEAR(drive.command.acceleration_mps2, 0.8F, 0.05F);
}

// A steering that stands 0.01 rad to the left: at 10 m/s it is within 5 cm of the line after 20 s.
TEST(Tracker, LearnsASteeringOffset) {
  TrackedDrive drive(straight(10.0));
  drive.plant.speed_mps = 10.0;
  drive.plant.steering_offset_rad = 0.01;
  drive.run(20.0);
  EXPECT_NEAR(drive.plant.y_m, 0.0, 0.05);
  EXPECT_NEAR(drive.command.steering_rad, -0.01F, 0.002F);
}

// ECU-051: 30 s out of reach of a plan 100 m ahead, then on one at hand: the command is that of a controller
// without this past, so nothing was wound up.
TEST(Tracker, DoesNotWindUp) {
  EgoState ego;
  ego.speed_mps = 5.0F;
  const Parameters parameters;
  const Plan far = plan_of(straight(5.0), 20000);
  const Plan here = plan_of(straight(5.0), 0);
  Tracker stuck;
  gate::Command command;
  for (int i = 0; i < 3000; ++i) command = stuck.follow(far, 20000, ego, parameters);
  EXPECT_EQ(command.acceleration_mps2, 3.0F);  // the feedback's bound
  EXPECT_NEAR(stuck.follow(here, 0, ego, parameters).acceleration_mps2,
              Tracker().follow(here, 0, ego, parameters).acceleration_mps2, 1e-3F);
  // And on a slope steeper than the trim's bound of 1 m/s^2 the trim ends there.
  Plan near = here;
  for (TrajectoryPoint& point : near.trajectory.points) point.rear_axle.x_m += 0.5F;
  for (int i = 0; i < 6000; ++i) command = stuck.follow(near, 0, ego, parameters);
  EXPECT_NEAR(command.acceleration_mps2, 1.0F + 0.6F * 0.5F, 1e-3F);
}

}  // namespace
}  // namespace s4tp::ecu
