#include "firmware/ecu/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

/// Where a scripted drive wants the car at a time.
using Script = std::function<TrajectoryPoint(double time_s)>;

Plan plan_of(const Script& script, std::uint32_t start_ms) {
  Plan plan;
  plan.kind = PlanKind::kDrive;
  plan.start_ms = start_ms;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    plan.trajectory.points[i] = script(0.001 * start_ms + 0.1 * i);
  }
  return plan;
}

/// Tracker, gate-less, on the plant; a new plan every 100 ms, each a piece of the script.
class Drive {
 public:
  explicit Drive(Script script) : script_(std::move(script)) {
    parameters.tracking.understeer = parameters.tracking.rear_slip = 0.0F;  // the plant's tyres do not slip
  }

  void run(double duration_s) {
    for (int i = 0; i < static_cast<int>(duration_s * 100.0 + 0.5); ++i) {
      if (now_ms % 100 == 0) plan = plan_of(script_, now_ms);
      EgoState ego;
      ego.rear_axle = {static_cast<float>(plant.x_m), static_cast<float>(plant.y_m),
                       static_cast<float>(plant.heading_rad)};
      ego.speed_mps = static_cast<float>(plant.speed_mps);
      ego.acceleration_mps2 = static_cast<float>(plant.acceleration_mps2);
      ego.yaw_rate_radps = static_cast<float>(plant.yaw_rate_radps);
      ego.steering_rad = static_cast<float>(plant.steering_rad);
      const gate::Command last = command;
      command = tracker.follow(plan, now_ms, ego, parameters);
      worst_cross_m = std::max(worst_cross_m, std::abs(tracker.error().cross_m));
      worst_along_m = std::max(worst_along_m, std::abs(tracker.error().along_m));
      worst_rise_mps3 =
          std::max(worst_rise_mps3, 100.0F * (command.acceleration_mps2 - last.acceleration_mps2));
      plant.step(command);
      now_ms += 10;
    }
  }
  void forget() { worst_cross_m = worst_along_m = worst_rise_mps3 = 0.0F; }

  Plant plant;
  Tracker tracker;
  Parameters parameters;
  Plan plan;
  gate::Command command;
  std::uint32_t now_ms = 0;
  float worst_cross_m = 0.0F;
  float worst_along_m = 0.0F;
  float worst_rise_mps3 = 0.0F;

 private:
  Script script_;
};

/// Straight ahead along x with the speed given, from x = 0.
Script straight(double speed_mps) {
  return [speed_mps](double time_s) {
    TrajectoryPoint point;
    point.rear_axle.x_m = static_cast<float>(speed_mps * time_s);
    point.speed_mps = static_cast<float>(speed_mps);
    return point;
  };
}

/// 5 m/s: straight for 10 m, a left turn of 90 degrees at 10.7 m radius entered and left over 3 m (clothoid),
/// straight again. Integrated in small steps once.
Script left_turn(double speed_mps) {
  const double turn_1pm = 1.0 / 10.7;
  const double ramp_m = 3.0;
  const double arc_m = 1.5707963 / turn_1pm - ramp_m;
  const auto curvature = [=](double s) {
    const double in = s - 10.0;
    if (in <= 0.0) return 0.0;
    if (in < ramp_m) return turn_1pm * in / ramp_m;
    if (in < ramp_m + arc_m) return turn_1pm;
    return std::max(0.0, turn_1pm * (2.0 * ramp_m + arc_m - in) / ramp_m);
  };
  return [=](double time_s) {
    TrajectoryPoint point;
    double x = 0.0;
    double y = 0.0;
    double heading = 0.0;
    const double length_m = speed_mps * time_s;
    const double step_m = 0.01;
    for (double s = 0.0; s < length_m; s += step_m) {
      const double piece_m = std::min(step_m, length_m - s);
      heading += piece_m * curvature(s + 0.5 * piece_m);
      x += piece_m * std::cos(heading);
      y += piece_m * std::sin(heading);
    }
    point.rear_axle = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(heading)};
    point.speed_mps = static_cast<float>(speed_mps);
    point.curvature_1pm = static_cast<float>(curvature(length_m));
    return point;
  };
}

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
    Drive drive(straight(speed_mps));
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
  Drive drive(left_turn(5.0));
  drive.plant.speed_mps = 5.0;
  drive.run(7.0);
  EXPECT_LT(drive.worst_cross_m, 0.3F);
  EXPECT_LT(drive.worst_cross_m, 0.08F) << "not the limit, but what it does";
  EXPECT_NEAR(drive.plant.heading_rad, 1.5708, 0.02);
}

// The same with actuators half as slow again as the controller believes.
TEST(Tracker, FollowsTheLeftTurnWithSlowActuators) {
  Drive drive(left_turn(5.0));
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
  const Script ring = [](double t) {
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
    Drive drive(ring);
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
  const Script script = left_turn(5.0);
  Drive drive([&script](double t) { return script(t + 0.2); });
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
  Drive drive(stop_and_go);
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
  Drive drive(stop_and_go);
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
  Drive drive(straight(10.0));
  drive.plant.speed_mps = 10.0;
  drive.plant.drag_mps2 = 0.8;
  drive.run(20.0);
  EXPECT_NEAR(drive.tracker.error().along_m, 0.0, 0.15);
  EXPECT_NEAR(drive.command.acceleration_mps2, 0.8F, 0.05F);
}

// A steering that stands 0.01 rad to the left: at 10 m/s it is within 5 cm of the line after 20 s.
TEST(Tracker, LearnsASteeringOffset) {
  Drive drive(straight(10.0));
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

// ECU-052 ECU-053: past its end of 3 s a plan is braked along with 4 m/s^2.
TEST(Tracker, StopsPastThePlansEnd) {
  EgoState ego;
  ego.rear_axle.x_m = 30.0F;
  ego.speed_mps = 10.0F;
  Tracker tracker;
  const Plan plan = plan_of(straight(10.0), 0);
  EXPECT_NEAR(tracker.follow(plan, 3000, ego, {}).acceleration_mps2, 0.0F, 0.2F);
  EXPECT_EQ(tracker.follow(plan, 3010, ego, {}).acceleration_mps2, -4.0F);
  EXPECT_EQ(tracker.error().distance_m, 0.0F);
}

// ECU-095 ECU-053: a plan to drive whose fail-safe branches after 0.35 s is braked along with 6 m/s^2 from
// then on; one that is a stop itself is followed.
TEST(Tracker, DrivesTheFailSafePastItsBranch) {
  EgoState ego;
  ego.rear_axle.x_m = 3.6F;
  ego.speed_mps = 10.0F;
  Plan plan = plan_of(straight(10.0), 0);
  plan.fail_safe = {0.35F, 6.0F};
  Tracker tracker;
  EXPECT_GT(tracker.follow(plan, 350, ego, {}).acceleration_mps2, -1.0F);
  EXPECT_EQ(tracker.follow(plan, 360, ego, {}).acceleration_mps2, -6.0F);
  plan.kind = PlanKind::kMinimumRisk;
  EXPECT_GT(Tracker().follow(plan, 360, ego, {}).acceleration_mps2, -1.0F);
}

// ECU-053: stopping out of the turn's middle stays on the turn; and brakes as hard as the plan where that is
// harder.
TEST(Tracker, StopsAlongThePlansPath) {
  const Script script = left_turn(5.0);
  Drive drive(script);
  drive.plant.speed_mps = 5.0;
  drive.run(4.0);
  const Plan last = drive.plan;
  double worst_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    EgoState ego;
    ego.rear_axle = {static_cast<float>(drive.plant.x_m), static_cast<float>(drive.plant.y_m),
                     static_cast<float>(drive.plant.heading_rad)};
    ego.speed_mps = static_cast<float>(drive.plant.speed_mps);
    drive.plant.step(drive.tracker.stop(last, ego, drive.parameters));
    if (i % 50 != 0) continue;
    double nearest_m = 1e9;
    for (double t = 4.0; t < 5.5; t += 0.01) {
      const Pose path = script(t).rear_axle;
      nearest_m = std::min(nearest_m, std::hypot(static_cast<double>(path.x_m) - drive.plant.x_m,
                                                 static_cast<double>(path.y_m) - drive.plant.y_m));
    }
    worst_m = std::max(worst_m, nearest_m);
  }
  EXPECT_EQ(drive.plant.speed_mps, 0.0);
  EXPECT_LT(worst_m, 0.1);

  Plan hard = plan_of(straight(10.0), 0);
  for (TrajectoryPoint& point : hard.trajectory.points) point.acceleration_mps2 = -7.0F;
  EgoState ego;
  ego.speed_mps = 10.0F;
  EXPECT_EQ(Tracker().stop(hard, ego, {}).acceleration_mps2, -7.0F);
}

// ECU-054: the same braking, whatever the speed told; a sensor that says 0 at 14 m/s does not let the car
// roll on.
TEST(Tracker, StopsWhateverTheSpeedSensorSays) {
  EgoState ego;
  EXPECT_EQ(Tracker().stop(Plan{}, ego, {}).acceleration_mps2, -4.0F);
  EXPECT_EQ(Tracker().stop(plan_of(straight(10.0), 0), ego, {}).acceleration_mps2, -4.0F);
}

// ECU-053: without a plan, or 4 m beside it, the wheels stay where they are.
TEST(Tracker, StopsWithoutAPlan) {
  EgoState ego;
  ego.speed_mps = 10.0F;
  ego.steering_rad = 0.123F;
  EXPECT_EQ(Tracker().stop(Plan{}, ego, {}).steering_rad, 0.123F);
  EXPECT_EQ(Tracker().follow(Plan{}, 0, ego, {}).acceleration_mps2, -4.0F);
  ego.rear_axle.y_m = 4.0F;
  EXPECT_EQ(Tracker().stop(plan_of(straight(10.0), 0), ego, {}).steering_rad, 0.123F);
}

}  // namespace
}  // namespace s4tp::ecu
