#include "algo/safety/fail_safe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::safety {
namespace {

constexpr std::uint32_t kStartMs = 1000;

/// 10 m/s straight ahead, with a fail-safe.
Plan straight_plan(float branch_s) {
  Plan plan;
  plan.kind = PlanKind::kDrive;
  plan.start_ms = kStartMs;
  plan.fail_safe = {branch_s, 6.0F};
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    plan.trajectory.points[i].rear_axle.x_m = static_cast<float>(i);
    plan.trajectory.points[i].speed_mps = 10.0F;
  }
  return plan;
}

// FAIL-001 200 ms into a plan with a branch after 1 s, 0.8 s of it are left: 8 m at 10 m/s, then 6 m/s^2 once
// the brake has built up (40 m/s^3: 0.15 s). 2.2 s later the speed has fallen by 2.2 x 6 at most, to rest.
TEST(FailSafe, DrivesToTheBranchThenBrakes) {
  const Plan plan = straight_plan(1.0F);
  Plan result;
  safety::drive_fail_safe(plan, sample(plan, kStartMs + 200), kStartMs + 200, 6.0F, Parameters{}, result);
  EXPECT_EQ(result.kind, PlanKind::kMinimumRisk);
  EXPECT_EQ(result.start_ms, kStartMs + 200);
  EXPECT_NEAR(result.fail_safe.branch_s, 0.8F, 1e-5F);
  EXPECT_NEAR(result.trajectory.points[8].rear_axle.x_m, 10.0F, 0.01F);
  EXPECT_NEAR(result.trajectory.points[8].speed_mps, 10.0F, 0.01F);
  EXPECT_LT(result.trajectory.points[12].acceleration_mps2, -5.9F);
  EXPECT_EQ(result.trajectory.points[kHorizonSteps].speed_mps, 0.0F);
  // 10 m, then v^2 / 2b = 8.3 m and up to 2 m for the build-up.
  EXPECT_NEAR(result.trajectory.points[kHorizonSteps].rear_axle.x_m, 19.3F, 1.0F);
}

// FAIL-001 Driven cycle by cycle, each from the one before, it is the same motion.
TEST(FailSafe, IsItsOwnContinuation) {
  const Plan plan = straight_plan(1.0F);
  Plan whole;
  safety::drive_fail_safe(plan, plan.trajectory.points[0], kStartMs, 6.0F, Parameters{}, whole);
  Plan running = plan;
  TrajectoryPoint state = plan.trajectory.points[0];
  for (int i = 0; i < kHorizonSteps; ++i) {
    Plan next;
    safety::drive_fail_safe(running, state, kStartMs + static_cast<std::uint32_t>(i * kStepMs), 6.0F,
                            Parameters{}, next);
    state = next.trajectory.points[1];
    running = next;
    EXPECT_NEAR(state.speed_mps, whole.trajectory.points[i + 1].speed_mps, 0.05F) << i;
    EXPECT_NEAR(state.rear_axle.x_m, whole.trajectory.points[i + 1].rear_axle.x_m, 0.05F) << i;
  }
}

// FAIL-001 Half a metre beside the plan its path is driven in parallel: y stays.
TEST(FailSafe, InParallelToThePlan) {
  const Plan plan = straight_plan(0.35F);
  TrajectoryPoint start = plan.trajectory.points[0];
  start.rear_axle.y_m = 0.5F;
  Plan result;
  safety::drive_fail_safe(plan, start, kStartMs, 6.0F, Parameters{}, result);
  EXPECT_FLOAT_EQ(result.trajectory.points[kHorizonSteps].rear_axle.y_m, 0.5F);
}

// FAIL-002 Past the plan's 3 s, and without one, it brakes at once with the present steering: a curvature of
// 0.05 / m is kept.
TEST(FailSafe, BrakesAsSteeredWithoutAPlan) {
  TrajectoryPoint start;
  start.speed_mps = 8.0F;
  start.curvature_1pm = 0.05F;
  for (const Plan& plan : {Plan{}, straight_plan(3.0F)}) {
    Plan result;
    safety::drive_fail_safe(plan, start, kStartMs + 3100, 6.0F, Parameters{}, result);
    EXPECT_EQ(result.fail_safe.branch_s, 0.0F);
    EXPECT_LT(result.trajectory.points[1].speed_mps, 8.0F);
    EXPECT_FLOAT_EQ(result.trajectory.points[5].curvature_1pm, 0.05F);
    EXPECT_EQ(result.trajectory.points[kHorizonSteps].speed_mps, 0.0F);
  }
}

// FAIL-001 A plan that brakes with 8 m/s^2, say for a bend, is no path to be driven with 6: wherever the stop is, the plan
// was as slow there, v^2 = 400 - 16 x, but for what the brakes take to follow.
TEST(FailSafe, BrakesAsHardAsThePlanDidThere) {
  Plan plan = straight_plan(0.35F);
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    const float time_s = std::fmin(2.5F, kStepS * static_cast<float>(i));
    TrajectoryPoint& point = plan.trajectory.points[i];
    point.rear_axle.x_m = 20.0F * time_s - 4.0F * time_s * time_s;
    point.speed_mps = 20.0F - 8.0F * time_s;
    point.acceleration_mps2 = time_s < 2.5F ? -8.0F : 0.0F;
  }
  Plan result;
  safety::drive_fail_safe(plan, plan.trajectory.points[0], kStartMs, 6.0F, Parameters{}, result);
  for (const TrajectoryPoint& point : result.trajectory.points) {
    const float planned_mps = std::sqrt(std::fmax(0.0F, 400.0F - 16.0F * point.rear_axle.x_m));
    EXPECT_LE(point.speed_mps, planned_mps + 0.2F) << point.rear_axle.x_m;
  }
  EXPECT_EQ(result.trajectory.points[kHorizonSteps].speed_mps, 0.0F);
}

// FAIL-001 Round a circle of 20 m, from half a second before the plan's end on: beyond it the stop goes on round the circle.
TEST(FailSafe, GoesOnRoundTheBendBeyondThePlan) {
  Plan plan = straight_plan(3.0F);
  plan.trajectory.points[0].curvature_1pm = 0.05F;
  for (int i = 1; i < kTrajectoryPoints; ++i)
    plan.trajectory.points[i] = trajectory::bicycle_step(plan.trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
  Plan result;
  safety::drive_fail_safe(plan, sample(plan, kStartMs + 2500), kStartMs + 2500, 6.0F, Parameters{}, result);
  for (const TrajectoryPoint& point : result.trajectory.points)
    EXPECT_NEAR(std::hypot(point.rear_axle.x_m, point.rear_axle.y_m - 20.0F), 20.0F, 0.05F);
  const TrajectoryPoint& end = result.trajectory.points[kHorizonSteps];
  EXPECT_NEAR(
      std::remainder(end.rear_axle.heading_rad - std::atan2(end.rear_axle.x_m, 20.0F - end.rear_axle.y_m),
                     2.0F * 3.14159265F),
      0.0F, 0.01F);
}

// FAIL-002, CAND-020 Headed 0.5 rad away from the plan no vehicle drives in parallel to it: it brakes as it is steered, and
// the next cycle knows that for ours. Headed 0.2 rad away it drives in parallel.
TEST(FailSafe, LeavesAPlanThatHeadsElsewhere) {
  const Plan plan = straight_plan(0.35F);
  for (const float heading_rad : {0.2F, 0.5F}) {
    TrajectoryPoint start = plan.trajectory.points[0];
    start.rear_axle.heading_rad = heading_rad;
    Plan result;
    safety::drive_fail_safe(plan, start, kStartMs, 6.0F, Parameters{}, result);
    EXPECT_TRUE(trajectory::keeps_limits(result.trajectory, Parameters{})) << heading_rad;
    EXPECT_EQ(result.trajectory.points[5].rear_axle.heading_rad, heading_rad < 0.3F ? 0.0F : heading_rad);
    EXPECT_EQ(result.fail_safe.branch_s, heading_rad < 0.3F ? 0.35F : 0.0F);
  }
}

// FAIL-002, CAND-020 Nobody brakes harder than the vehicle can: asked for 6 m/s^2 where that is 3.
TEST(FailSafe, BrakesNoHarderThanTheVehicle) {
  TrajectoryPoint start;
  start.speed_mps = 8.0F;
  Parameters parameters;
  parameters.vehicle.braking_max_mps2 = 3.0F;
  Plan result;
  safety::drive_fail_safe(Plan{}, start, kStartMs, 6.0F, parameters, result);
  EXPECT_EQ(result.trajectory.points[1].acceleration_mps2, -3.0F);
  EXPECT_TRUE(trajectory::keeps_limits(result.trajectory, parameters));
}

// CAND-020 A stop gives up its last crawl within a step (0.868 m/s at 8 m/s^2): it is known for ours. 1 m/s is not.
TEST(FailSafe, AStopIsKnownForOursToItsLastStep) {
  for (const float last_mps : {0.868F, 1.0F}) {
    Trajectory stop;
    for (int i = kHorizonSteps - 1; i >= 0; --i) {
      const TrajectoryPoint& after = stop.points[i + 1];
      TrajectoryPoint& point = stop.points[i];
      point.speed_mps = i == kHorizonSteps - 1 ? last_mps : after.speed_mps + 0.8F;
      point.acceleration_mps2 = -8.0F;
      point.rear_axle.x_m = after.rear_axle.x_m - 0.5F * kStepS * (point.speed_mps + after.speed_mps);
    }
    EXPECT_EQ(trajectory::keeps_limits(stop, Parameters{}), last_mps < 0.9F);
  }
}

}  // namespace
}  // namespace s4tp::safety
