#include "algo/safety/fail_safe.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace s4tp::safety
