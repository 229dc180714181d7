// What the planner takes for its input, and what it answers to what cannot be: broken numbers, plans that are not its own.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algo/planner/planner.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/plan_limits.hpp"
#include "tests/support/planner_drive.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::planner {
namespace {

using test::on_straight_road;
using Drive = test::PlannerDrive;

// CORE-005: one NaN anywhere in the input, and the plan is the minimum-risk manoeuvre, finite in every
// number; the optimizer was asked nothing.
TEST(Planner, NeverUsesABrokenInput) {
  Drive drive = on_straight_road(10.0F);
  ASSERT_EQ(drive.step(), Status::kOk);
  EXPECT_NE(drive.planner->last_refinement(), nullptr);
  drive.input.ego.speed_mps = std::numeric_limits<float>::quiet_NaN();
  Plan plan;
  EXPECT_EQ(drive.planner->plan(drive.input, plan, drive.explanation), Status::kInvalidInput);
  EXPECT_EQ(plan.kind, PlanKind::kMinimumRisk);
  EXPECT_EQ(drive.planner->last_refinement(), nullptr);
  for (const TrajectoryPoint& point : plan.trajectory.points) {
    EXPECT_TRUE(std::isfinite(point.rear_axle.x_m) && std::isfinite(point.speed_mps) &&
                std::isfinite(point.curvature_1pm));
  }
}

// CORE-030: lists stop while a vehicle stands ahead, and the stop promised brakes with 3 m/s^2. From 11 m/s the guard's own
// 6 m/s^2 take 10.1 m: where there are fewer, the stop asked for after 0.6 s is as hard as can be; with room enough, or
// nobody there, it is as promised.
TEST(Planner, StopsForThoseItCannotSeeAnyMore) {
  for (const float gap_m : {9.0F, 60.0F, 300.0F}) {
    Drive drive = on_straight_road(11.0F);
    const PlannerInput before = drive.input;
    const float to_front_m = drive.parameters.vehicle.length_m - drive.parameters.vehicle.rear_overhang_m;
    ASSERT_TRUE(drive.input.tracks.push(test::car(1, 20.0F + to_front_m + gap_m + 2.25F, 0.0F, 0.0F, 0.0F)));
    (void)drive.step();
    drive.input.ego = before.ego;
    drive.input.tracks_ms = before.now_ms;
    drive.input.now_ms = before.now_ms + 600;
    drive.input.start_ms = before.start_ms + 600;
    drive.running.kind = PlanKind::kDrive;
    drive.running.start_ms = drive.input.now_ms;
    drive.running.fail_safe = {0.0F, 3.0F};
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      TrajectoryPoint& point = drive.running.trajectory.points[i];
      point = TrajectoryPoint{};
      point.rear_axle.x_m = 20.0F + 1.1F * static_cast<float>(i);
      point.speed_mps = 11.0F;
    }
    Plan plan;
    ASSERT_EQ(drive.planner->plan(drive.input, plan, drive.explanation), Status::kStaleTracks);
    EXPECT_EQ(plan.kind, PlanKind::kMinimumRisk);
    const float hardest_mps2 = drive.parameters.vehicle.braking_max_mps2;
    EXPECT_EQ(plan.fail_safe.braking_mps2, gap_m < 20.0F ? hardest_mps2 : 3.0F) << gap_m;
  }
}

// CORE-007: two lanes become one, we give way, and the plan in force drives through with 5 m/s. Our centre is at 93.6 m: 8 m/s^2 end
// before the ground at 96, the guard's own stop (0.35 s, then 6 m/s^2) at 97.4 does not. One that comes from nowhere with 8 m/s, 6 m before
// that ground, cannot stop any more: the answer is the hardest stop, at once. One that is 46 m away can.
TEST(Planner, StopsAtOnceForOneThatCannot) {
  for (const float its_s_m : {90.0F, 50.0F}) {
    test::SharedGround road(Priority::kFirstYields, true);
    const LaneIndex theirs = road.zone().other_lane;
    (void)road.map.conflicts.push({0, theirs, Priority::kFirstYields, 96.0F, 104.0F, 96.0F, 104.0F});
    Drive drive(road.map);
    const float rear_axle_x_m = -6.4F - trajectory::rear_axle_to_centre_m(drive.parameters);
    drive.input.ego.rear_axle = {rear_axle_x_m, 0.0F, 0.0F};
    drive.input.ego.speed_mps = 5.0F;
    ASSERT_TRUE(drive.input.tracks.push(test::car(1, its_s_m - 99.144F, -3.6F, 0.0F, 8.0F)));
    drive.running.kind = PlanKind::kDrive;
    drive.running.fail_safe = {2.5F, 6.0F};
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      TrajectoryPoint& point = drive.running.trajectory.points[i];
      point.rear_axle.x_m = rear_axle_x_m + 0.5F * static_cast<float>(i);
      point.speed_mps = 5.0F;
    }
    drive.input.start_ms = 0;
    drive.input.running = &drive.running;
    drive.input.map = &road.map;
    Plan plan;
    const Status status = drive.planner->plan(drive.input, plan, drive.explanation);
    const float hardest_mps2 = drive.parameters.vehicle.braking_max_mps2;
    EXPECT_EQ(plan.fail_safe.branch_s == 0.0F && plan.fail_safe.braking_mps2 == hardest_mps2,
              its_s_m > 80.0F);
    EXPECT_EQ(status, its_s_m > 80.0F ? Status::kNoSafePlan : Status::kOk);
  }
}

/// Any one number of a plan.
float& number_of(Plan& plan, int which) {
  TrajectoryPoint& point = plan.trajectory.points[which % kTrajectoryPoints];
  float* const numbers[] = {&point.rear_axle.x_m, &point.rear_axle.y_m,     &point.rear_axle.heading_rad,
                            &point.speed_mps,     &point.acceleration_mps2, &point.curvature_1pm};
  return *numbers[which / kTrajectoryPoints];
}

// CORE-014, CAND-019: any single number of the running plan made absurd is a plan none of ours: invalid
// input, and the answer is a stop from where we are, in range itself.
TEST(Planner, TakesNoRunningPlanThatCannotBeOurs) {
  Drive drive = on_straight_road(10.0F);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(drive.step(), Status::kOk);
  const Plan good = drive.running;
  for (int which = 0; which < 6 * kTrajectoryPoints; ++which) {
    for (const float absurd : {1e30F, -1e30F, 200.0F, -14.0F}) {
      const bool position = which < 2 * kTrajectoryPoints;
      if (position && std::abs(number_of(drive.running, which) - absurd) < 3.0F) continue;
      number_of(drive.running, which) = absurd;
      Plan plan;
      drive.input.running = &drive.running;
      ASSERT_EQ(drive.planner->plan(drive.input, plan, drive.explanation), Status::kInvalidInput)
          << which << " " << absurd;
      ASSERT_EQ(plan.kind, PlanKind::kMinimumRisk);
      ASSERT_TRUE(trajectory::keeps_limits(plan.trajectory, Parameters{}));
      ASSERT_NEAR(plan.trajectory.points[0].rear_axle.x_m, drive.input.ego.rear_axle.x_m + 1.0F, 0.1F);
      drive.running = good;
    }
  }
}

// CORE-014, CAND-020: a running plan that drives off with 5.8 m/s^2 where the car has 3.5, true to its own
// speeds: the plan is not gone on with.
TEST(Planner, TakesNoRunningPlanBeyondTheCarsLimits) {
  Drive drive = on_straight_road(10.0F);
  ASSERT_EQ(drive.step(), Status::kOk);
  for (const float acceleration_mps2 : {3.5F, 5.8F}) {
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      TrajectoryPoint& point = drive.running.trajectory.points[i];
      point = drive.running.trajectory.points[i > 0 ? i - 1 : 0];
      if (i > 0) point = trajectory::bicycle_step(point, acceleration_mps2, 0.0F, kStepS);
    }
    Plan plan;
    drive.input.running = &drive.running;
    const Status expected = acceleration_mps2 > 3.5F ? Status::kInvalidInput : Status::kOk;
    EXPECT_EQ(drive.planner->plan(drive.input, plan, drive.explanation), expected);
    EXPECT_TRUE(trajectory::keeps_limits(plan.trajectory, Parameters{}));
  }
}

// CORE-014: a running plan true to itself that turns with 0.3 1/m at 10 m/s, 30 m/s^2 to the side, while our wheels stand
// straight: it is not ours, and what it asks for is not gone on with.
TEST(Planner, GoesOnFromNoCurvatureItsWheelsAreFarFrom) {
  Drive drive = on_straight_road(10.0F);
  ASSERT_EQ(drive.step(), Status::kOk);
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    TrajectoryPoint& point = drive.running.trajectory.points[i];
    point = drive.running.trajectory.points[i > 0 ? i - 1 : 0];
    point.curvature_1pm = 0.3F;
    if (i > 0) point = trajectory::bicycle_step(point, 0.0F, 0.0F, kStepS);
  }
  ASSERT_TRUE(trajectory::keeps_limits(drive.running.trajectory, Parameters{}));
  Plan plan;
  drive.input.running = &drive.running;
  EXPECT_EQ(drive.planner->plan(drive.input, plan, drive.explanation), Status::kOk);
  for (const TrajectoryPoint& point : plan.trajectory.points)
    EXPECT_LE(point.speed_mps * point.speed_mps * std::abs(point.curvature_1pm), 4.0F);
}

}  // namespace
}  // namespace s4tp::planner
