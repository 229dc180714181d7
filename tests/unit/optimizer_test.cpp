// Refinement of one candidate: what it is for, and what it must leave alone.

#include "algo/trajectory/optimizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "algo/trajectory/ilqr_backward.hpp"
#include "tests/support/refinement_scenes.hpp"

namespace s4tp::trajectory {
namespace {

using test::RefinementScene;

/// On a straight road, braking with `acceleration_mps2`; jerk as candidates have it.
std::unique_ptr<RefinementScene> braking(float acceleration_mps2, float speed_mps = 13.0F) {
  auto scene = std::make_unique<RefinementScene>();
  scene->map = test::straight_road(2, 300.0F);
  const scene::LanePath path = test::path_of(scene->map, {0});
  (void)test::add_ego_path(scene->scene, scene->map, path);
  const TrajectoryPoint start = test::state_on(scene->map, path, 50.0F, speed_mps);
  test::put_ego(scene->scene, start);
  build_reference(scene->map, path, 50.0F, start.speed_mps, scene->parameters, scene->line);
  scene->candidate.acceleration_mps2 = acceleration_mps2;
  shape_lateral(scene->line, start, {50.0F, 0.0F}, 20.0F, scene->candidate);
  roll_out(scene->line, scene->candidate, start, Plan{}, 0, scene->parameters, scene->trajectory);
  return scene;
}

RefinementResult refine(RefinementScene& scene, int passes) {
  const Trajectory candidate = scene.trajectory;
  return std::make_unique<Optimizer>()->refine(scene.line, scene.candidate.start_s_m, scene.surroundings(),
                                               scene.parameters, {passes, 0}, candidate, scene.trajectory);
}

float mean_squared_jerk(const Trajectory& trajectory) {
  float sum = 0.0F;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    sum += square((trajectory.points[i].acceleration_mps2 - trajectory.points[i - 1].acceleration_mps2) /
                  kStepS);
  }
  return sum / static_cast<float>(kHorizonSteps);
}

// CAND-011 Without an allowance the candidate comes back to the bit, after no pass.
TEST(Optimizer, GivesBackTheCandidateWhenThereIsNoAllowance) {
  const auto scene = braking(-3.0F);
  const Trajectory before = scene->trajectory;
  EXPECT_EQ(refine(*scene, 0).passes, 0);
  EXPECT_EQ(std::memcmp(&before, &scene->trajectory, sizeof(before)), 0);
}

// Braking that sets in with 12 m/s^3 (mean square over the horizon 10) becomes half as jerky or less, while
// the end stays within 0.5 m and 0.3 m/s.
TEST(Optimizer, SmoothsTheOnsetOfBraking) {
  const auto scene = braking(-3.0F);
  const Trajectory before = scene->trajectory;
  const RefinementResult result = refine(*scene, 16);
  EXPECT_TRUE(result.improved);
  EXPECT_LT(result.own_after, 0.7F * result.own_before);
  EXPECT_GT(mean_squared_jerk(before), 8.0F);
  EXPECT_LT(mean_squared_jerk(scene->trajectory), 0.67F * mean_squared_jerk(before));
  const TrajectoryPoint& end = scene->trajectory.points[kHorizonSteps];
  EXPECT_NEAR(end.rear_axle.x_m, before.points[kHorizonSteps].rear_axle.x_m, 0.5F);
  EXPECT_NEAR(end.speed_mps, before.points[kHorizonSteps].speed_mps, 0.3F);
}

// Half a m/s below the limit and less, refining gains little (0.014 of the score at 13.7 m/s), and is done
// nevertheless: where it ends, one more correction promises at most a thousandth of the cost, or 1e-6. Twice
// that is allowed, for float.
TEST(Optimizer, GoesOnUntilLittleIsLeft) {
  for (const float speed_mps : {13.5F, 13.7F, 13.8F}) {
    const auto scene = braking(1.0F, speed_mps);
    scene->build();
    const IlqrResult result = std::make_unique<Ilqr>()->solve(scene->problem, 16, scene->start);
    EXPECT_LT(result.cost_after, 0.25F * result.cost_before) << speed_mps;
    EXPECT_LT(result.passes, 16) << speed_mps;
    InputCorrection corrections[kHorizonSteps];
    const float promised = backward_pass(scene->problem, BoundState{}, scene->start, 0.0F, corrections);
    EXPECT_LE(promised, 2.0F * max(1e-3F * result.cost_after, 1e-6F)) << speed_mps;
  }
}

// A car drives beside us, 0.45 m from side to side: the plan makes room, as far as its candidate lets it, and
// from 0.5 s on is never nearer than before.
TEST(Optimizer, MakesRoomForWhoIsNear) {
  const auto scene = braking(0.0F);
  const scene::LanePath path = test::path_of(scene->map, {0});
  const scene::Agent& agent = test::add_vehicle(scene->scene, scene->map, path, 53.0F, 13.0F, 2.25F);
  (void)scene->constant_velocity.agents.push(test::steady_future(scene->map, agent));
  satp::AgentPrediction predicted;
  (void)predicted.modes.push(test::steady_future(scene->map, agent));
  (void)scene->prediction.agents.push(predicted);
  EXPECT_TRUE(refine(*scene, 16).improved);
  for (int i = 5; i < kTrajectoryPoints; ++i) EXPECT_LE(scene->trajectory.points[i].rear_axle.y_m, 0.0F) << i;
  EXPECT_LT(scene->trajectory.points[20].rear_axle.y_m, -0.03F);
  EXPECT_GT(scene->trajectory.points[20].rear_axle.y_m, -1.0F);
}

// A candidate that would touch the car ahead's predicted box but for 0.35 m: however jerky the braking that
// keeps it, the refined plan keeps the check's 0.3 m as well.
TEST(Optimizer, KeepsItsDistance) {
  const auto scene = braking(-6.0F);
  const scene::LanePath path = test::path_of(scene->map, {0});
  const float front_m = scene->trajectory.points[kHorizonSteps].rear_axle.x_m + 4.0F;
  const scene::Agent& agent = test::add_vehicle(scene->scene, scene->map, path, front_m + 0.35F + 2.5F, 0.0F);
  (void)scene->constant_velocity.agents.push(test::steady_future(scene->map, agent));
  satp::AgentPrediction predicted;
  (void)predicted.modes.push(test::steady_future(scene->map, agent));
  (void)scene->prediction.agents.push(predicted);
  EXPECT_TRUE(refine(*scene, 16).improved);
  EXPECT_LE(scene->trajectory.points[kHorizonSteps].rear_axle.x_m + 4.0F, front_m + 0.05F + 0.005F);
}

}  // namespace
}  // namespace s4tp::trajectory
