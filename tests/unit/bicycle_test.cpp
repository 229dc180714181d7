// The kinematic bicycle and the vehicle's limits.

#include "algo/trajectory/bicycle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace s4tp::trajectory {
namespace {

TrajectoryPoint driving(float speed_mps, float curvature_1pm) {
  TrajectoryPoint state;
  state.speed_mps = speed_mps;
  state.curvature_1pm = curvature_1pm;
  return state;
}

/// A trajectory that goes on from `start` with one acceleration and one rate.
Trajectory steady(TrajectoryPoint start, float acceleration_mps2, float curvature_rate_1pms) {
  Trajectory trajectory;
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    trajectory.points[i] =
        bicycle_step(trajectory.points[i - 1], acceleration_mps2, curvature_rate_1pms, kStepS);
  }
  return trajectory;
}

// CAND-001 At rest with the wheels turned and the brake on, nothing moves, whatever the time step.
TEST(Bicycle, RestHoldsThePose) {
  TrajectoryPoint rest = driving(0.0F, 0.1F);
  rest.rear_axle = {12.3F, -4.5F, 0.7F};
  const TrajectoryPoint later = bicycle_step(rest, -3.0F, 0.0F, 0.1F);
  EXPECT_EQ(later.rear_axle.x_m, rest.rear_axle.x_m);
  EXPECT_EQ(later.rear_axle.y_m, rest.rear_axle.y_m);
  EXPECT_EQ(later.rear_axle.heading_rad, rest.rear_axle.heading_rad);
  EXPECT_EQ(later.speed_mps, 0.0F);
  EXPECT_EQ(later.acceleration_mps2, 0.0F);
}

// CAND-001 From 1 m/s with -5 m/s^2 rest comes after 0.2 s and 1 / (2 * 5) = 0.1 m, inside a step of 0.5 s.
TEST(Bicycle, StopsInsideAStep) {
  const TrajectoryPoint stopped = bicycle_step(driving(1.0F, 0.0F), -5.0F, 0.0F, 0.5F);
  EXPECT_EQ(stopped.speed_mps, 0.0F);
  EXPECT_NEAR(stopped.rear_axle.x_m, 0.1F, 1e-6F);
}

// CAND-002 At 10 m/s a circle of radius 20 m is 125.66 m long: closed after 126 steps of 0.1 s less 3 cm.
TEST(Bicycle, ClosesACircle) {
  TrajectoryPoint state = driving(10.0F, 0.05F);
  const float lap_s = 2.0F * 3.14159265F * 20.0F / 10.0F;
  for (int i = 0; i < 126; ++i) state = bicycle_step(state, 0.0F, 0.0F, lap_s / 126.0F);
  EXPECT_NEAR(state.rear_axle.x_m, 0.0F, 0.01F);
  EXPECT_NEAR(state.rear_axle.y_m, 0.0F, 0.01F);
  EXPECT_NEAR(state.rear_axle.heading_rad, 0.0F, 1e-4F);
}

// CAND-003 tan(0.5) / 2.9 = 0.1884 per metre; and back.
TEST(Bicycle, SteeringAndCurvatureAreInverse) {
  EXPECT_NEAR(curvature_for(0.5F, 2.9F), 0.18838F, 1e-5F);
  for (float angle = -0.8F; angle <= 0.8F; angle += 0.05F) {
    EXPECT_NEAR(steering_for(curvature_for(angle, 2.9F), 2.9F), angle, 1e-5F);
  }
}

// CAND-003 The 5 m car with 1 m behind its rear axle: centre 1.5 m, front 4 m ahead of the axle.
TEST(Bicycle, BoxLiesAheadOfTheRearAxle) {
  const Parameters parameters;
  EXPECT_FLOAT_EQ(rear_axle_to_centre_m(parameters), 1.5F);
  EXPECT_FLOAT_EQ(rear_axle_to_front_m(parameters), 4.0F);
  const Box box = ego_box({1.0F, 2.0F, 1.57079633F}, parameters);
  EXPECT_NEAR(box.centre.x_m, 1.0F, 1e-5F);
  EXPECT_NEAR(box.centre.y_m, 3.5F, 1e-5F);
}

// CAND-003 Each limit alone: 4.5 m/s^2 sideways, 0.55 rad, 0.6 rad/s, drive 3.5 and brake 8 m/s^2.
TEST(Feasible, EachLimitCounts) {
  const Parameters parameters;
  EXPECT_TRUE(feasible(steady(driving(10.0F, 0.0F), 0.0F, 0.0F), parameters));
  // Sideways: from 5 m/s on radius 10 m (2.5 m/s^2) speeding up reaches 4.5 at 6.7 m/s.
  EXPECT_TRUE(feasible(steady(driving(5.0F, 0.1F), 0.5F, 0.0F), parameters));
  EXPECT_FALSE(feasible(steady(driving(5.0F, 0.1F), 1.0F, 0.0F), parameters));
  // Angle: 0.3 s at 1/15 more a second ... 0.211 per metre is 0.55 rad.
  EXPECT_FALSE(feasible(steady(driving(1.0F, 0.15F), 0.0F, 0.05F), parameters));
  // Rate: near straight 2.9 * 0.25 = 0.73 rad/s.
  EXPECT_FALSE(feasible(steady(driving(0.5F, -0.1F), 0.0F, 0.25F), parameters));
  EXPECT_FALSE(feasible(steady(driving(5.0F, 0.0F), 3.7F, 0.0F), parameters));
  EXPECT_FALSE(feasible(steady(driving(30.0F, 0.0F), -8.3F, 0.0F), parameters));
  EXPECT_TRUE(feasible(steady(driving(30.0F, 0.0F), -8.0F, 0.0F), parameters));
}

// CAND-012 At 10 m/s points lie 1 m apart, give or take 10 cm: a point moved on or back by 0.2 m is no
// motion.
TEST(Feasible, PointsLieAsFarApartAsTheirSpeedsSay) {
  const Parameters parameters;
  for (const float moved_m : {-0.2F, 0.2F}) {
    Trajectory trajectory = steady(driving(10.0F, 0.0F), 0.0F, 0.0F);
    for (int i = 7; i < kTrajectoryPoints; ++i) trajectory.points[i].rear_axle.x_m += moved_m;
    EXPECT_FALSE(feasible(trajectory, parameters)) << moved_m;
  }
}

// CAND-004 A start at 10 m/s on radius 15 m pulls 6.7 m/s^2, over the limit: slowing down is still feasible,
// and speeding up is not.
TEST(Feasible, StartOutsideTheLimitsOnlyMustNotGetWorse) {
  const Parameters parameters;
  const TrajectoryPoint start = driving(10.0F, 1.0F / 15.0F);
  EXPECT_TRUE(feasible(steady(start, -2.0F, 0.0F), parameters));
  EXPECT_FALSE(feasible(steady(start, 1.0F, 0.0F), parameters));
}

}  // namespace
}  // namespace s4tp::trajectory
