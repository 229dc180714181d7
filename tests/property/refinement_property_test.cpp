// What refinement promises for any candidate among any vehicles.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/refinement_scenes.hpp"

namespace s4tp {
namespace {

constexpr int kPasses = 16;

std::unique_ptr<test::RefinementScene> arbitrary_scene() {
  const unsigned seed = *rc::gen::inRange(0U, 1000000000U);
  auto scene = test::random_refinement(seed);
  const bool feasible_at_all = scene != nullptr;
  RC_PRE(feasible_at_all);
  return scene;
}

Trajectory refined_of(const test::RefinementScene& scene, int passes, IlqrResult& result) {
  Trajectory refined = scene.trajectory;
  const auto optimizer = std::make_unique<Optimizer>();
  result = optimizer->refine(scene.line, scene.candidate.start_s_m, scene.surroundings(), scene.parameters,
                             passes, refined);
  return refined;
}

bool same(const Trajectory& a, const Trajectory& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

// CAND-011: with any allowance the cost is not above the candidate's, more passes never make it worse, and
// what is not improved comes back to the bit. The start stays where it is. Six failed trials count as a pass;
// the last pass may add three to what is allowed.
TEST(Refinement, IsNeverWorseThanItsStart) {
  EXPECT_TRUE(rc::check([] {
    const auto scene = arbitrary_scene();
    float before = INFINITY;
    for (const int passes : {0, 1, 2, 8, kPasses}) {
      IlqrResult result;
      const Trajectory refined = refined_of(*scene, passes, result);
      RC_ASSERT(result.passes <= passes);
      RC_ASSERT(6 * result.passes + result.failed_trials <= 6 * passes + 3);
      RC_ASSERT(result.cost_after <= result.cost_before);
      if (!result.improved) RC_ASSERT(same(refined, scene->trajectory));
      RC_ASSERT(std::memcmp(&refined.points[0], &scene->trajectory.points[0], sizeof(TrajectoryPoint)) == 0);
      if (passes > 0) RC_ASSERT(result.cost_after <= before);
      before = passes > 0 ? result.cost_after : before;
    }
  }));
}

// CAND-014: never further than 1.0 m along or across from the candidate, nor 0.5 s in time (at standstill 2
// cm), each with the 5 % of 0.2 m that bounds may be broken by; feasible; and no nearer to a predicted box
// than the check's margin, or than the candidate was.
TEST(Refinement, KeepsItsBounds) {
  int improved = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto scene = arbitrary_scene();
    IlqrResult result;
    const Trajectory refined = refined_of(*scene, kPasses, result);
    improved += result.improved ? 1 : 0;
    RC_ASSERT(feasible(refined, scene->parameters));
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const TrajectoryPoint& was = scene->trajectory.points[i];
      const TrajectoryPoint& is = refined.points[i];
      const Point off = to_local(was.rear_axle, position(is.rear_axle));
      RC_ASSERT(std::abs(off.x_m) <= std::min(1.0F, 0.5F * was.speed_mps + 0.02F) + 0.015F);
      RC_ASSERT(std::abs(off.y_m) <= 1.0F + 0.1F);  // across is measured from the bent path
      RC_ASSERT(is.speed_mps >= 0.0F);
      const Box before = ego_box(was.rear_axle, scene->parameters);
      const Box after = ego_box(is.rear_axle, scene->parameters);
      for (int k = 0; k < scene->scene.agents.size(); ++k) {
        const Track& track = scene->scene.agents[k].track;
        const Box other = {scene->prediction.agents[k].modes[0].steps[i - 1], track.length_m, track.width_m};
        const float kept_m = std::min(separation(before, other), scene->parameters.safety.margin_m + 0.02F);
        if (kept_m > 0.0F) RC_ASSERT(separation(after, other) >= kept_m - 0.006F);
      }
    }
  }));
  EXPECT_GT(improved, 50);
}

// CAND-013: whoever stands and is to stand, stands; 16 passes change no bit.
TEST(Refinement, AStopIsAFixedPoint) {
  EXPECT_TRUE(rc::check([] {
    const auto scene = arbitrary_scene();
    for (TrajectoryPoint& point : scene->trajectory.points) {
      point = scene->trajectory.points[0];
      point.speed_mps = 0.0F;
      point.acceleration_mps2 = 0.0F;
    }
    IlqrResult result;
    const Trajectory refined = refined_of(*scene, kPasses, result);
    RC_ASSERT(same(refined, scene->trajectory));
  }));
}

// A candidate that comes to rest still does: it stands at the end, within 4 cm along of where the
// candidate does.
TEST(Refinement, AStopStaysWhereItIs) {
  EXPECT_TRUE(rc::check([] {
    const auto scene = arbitrary_scene();
    const TrajectoryPoint& end = scene->trajectory.points[kHorizonSteps];
    RC_PRE(end.speed_mps <= 0.0F);
    IlqrResult result;
    const Trajectory refined = refined_of(*scene, kPasses, result);
    const TrajectoryPoint& there = refined.points[kHorizonSteps];
    RC_ASSERT(there.speed_mps < 0.1F);
    RC_ASSERT(std::abs(to_local(end.rear_axle, position(there.rear_axle)).x_m) < 0.04F);
  }));
}

}  // namespace
}  // namespace s4tp
