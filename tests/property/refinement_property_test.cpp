// What refinement promises for any candidate among any vehicles.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstring>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/refinement_scenes.hpp"

namespace s4tp::trajectory {
namespace {

constexpr int kPasses = 16;
constexpr int kEvaluations = 3;

std::unique_ptr<test::RefinementScene> arbitrary_scene() {
  const unsigned seed = *rc::gen::inRange(0U, 1000000000U);
  auto scene = test::random_refinement(seed);
  const bool feasible_at_all = scene != nullptr;
  RC_PRE(feasible_at_all);
  return scene;
}

Trajectory refined_of(const test::RefinementScene& scene, RefinementAllowance allowance,
                      RefinementResult& result) {
  Trajectory refined;
  const auto optimizer = std::make_unique<Optimizer>();
  result = optimizer->refine(scene.line, scene.candidate.start_s_m, scene.surroundings(), scene.parameters,
                             allowance, scene.trajectory, refined);
  return refined;
}

bool same(const Trajectory& a, const Trajectory& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

// CAND-011: with any allowance the cost is not above the candidate's, without the field more passes never
// make it worse, and what is not improved comes back to the bit. The start stays where it is. Six failed
// trials count as a pass; the last pass may add three to what is allowed.
TEST(Refinement, IsNeverWorseThanItsStart) {
  EXPECT_TRUE(rc::check([] {
    const auto scene = arbitrary_scene();
    for (const int evaluations : {0, 1, kEvaluations}) {
      float before = INFINITY;
      for (const int passes : {0, 1, 2, 8, kPasses}) {
        RefinementResult result;
        const Trajectory refined = refined_of(*scene, {passes, evaluations}, result);
        RC_ASSERT(result.passes <= passes);
        RC_ASSERT(result.evaluations <= evaluations);
        RC_ASSERT(6 * result.passes + result.failed_trials <= 6 * passes + 3);
        const float after = result.own_after + result.field_after;
        RC_ASSERT(after <= result.own_before + result.field_before);
        if (!result.improved) RC_ASSERT(same(refined, scene->trajectory));
        RC_ASSERT(std::memcmp(&refined.points[0], &scene->trajectory.points[0], sizeof(TrajectoryPoint)) ==
                  0);
        if (evaluations == 0 && passes > 0) RC_ASSERT(after <= before);
        before = passes > 0 ? after : before;
      }
    }
  }));
}

// CAND-023: whatever work the field is given, it takes no more; given none it is left out, given enough it is evaluated.
TEST(Refinement, TheFieldTakesNoMoreWorkThanItIsGiven) {
  int evaluated = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto scene = arbitrary_scene();
    for (const std::int32_t given : {0, kLeastFieldWork * kEvaluations, 4'000, 15'000}) {
      RefinementResult result;
      (void)refined_of(*scene, {kPasses, kEvaluations, given}, result);
      RC_ASSERT(result.field_work <= given);
      if (given == 0) RC_ASSERT(result.evaluations == 0);
      evaluated += given > 4'000 && result.evaluations > 0 ? 1 : 0;
    }
  }));
  EXPECT_GT(evaluated, 20);
}

// CAND-014: never further than 2.0 m along from the candidate, nor 0.5 s in time (at standstill 2 cm), nor
// beyond its bounds across, each with the 5 % of 0.2 m that bounds may be broken by; feasible; and no nearer
// to a predicted box than the check's margin, or than the candidate was, but for 2 cm: the gap's bound is a
// line at the candidate (of 60,000 random scenes one is 11.7 mm nearer).
TEST(Refinement, KeepsItsBounds) {
  int improved = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto scene = arbitrary_scene();
    RefinementResult result;
    const Trajectory refined = refined_of(*scene, {kPasses, kEvaluations}, result);
    improved += result.improved ? 1 : 0;
    RC_ASSERT(feasible(refined, scene->parameters));
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const TrajectoryPoint& was = scene->trajectory.points[i];
      const TrajectoryPoint& is = refined.points[i];
      const Point off = to_local(was.rear_axle, position(is.rear_axle));
      RC_ASSERT(std::abs(off.x_m) <= std::min(2.0F, 0.5F * was.speed_mps + 0.02F) + 0.015F);
      const RefinementStep& step = scene->problem.steps[i - 1];
      MotionState state;
      state.x_m = is.rear_axle.x_m - scene->trajectory.points[0].rear_axle.x_m;
      state.y_m = is.rear_axle.y_m - scene->trajectory.points[0].rear_axle.y_m;
      const float across_m = deviation_of(step, state).across_m;
      RC_ASSERT(across_m >= step.across_low_m - 0.015F && across_m <= step.across_high_m + 0.015F);
      RC_ASSERT(is.speed_mps >= 0.0F);
      const Box before = ego_box(was.rear_axle, scene->parameters);
      const Box after = ego_box(is.rear_axle, scene->parameters);
      for (int k = 0; k < scene->scene.agents.size(); ++k) {
        const Track& track = scene->scene.agents[k].track;
        const Box other = {scene->prediction.agents[k].modes[0].steps[i - 1], track.length_m, track.width_m};
        const float kept_m = std::min(separation(before, other), scene->parameters.safety.margin_m + 0.02F);
        if (kept_m > 0.0F) RC_ASSERT(separation(after, other) >= kept_m - 0.02F);
      }
    }
  }));
  EXPECT_GT(improved, 50);
}

// CAND-014: motions found to overstep the steering's rate (at most 0.66 of 0.6 rad/s) or the lateral bound,
// which are soft in the optimizer, or to roll on at the end of a stop (0.13 to 0.22 m/s): the candidate
// comes back.
TEST(Refinement, DropsWhatCannotBeDriven) {
  for (const unsigned seed : {27983U, 30581U, 33611U, 35030U, 44567U, 51833U, 116U, 8697U, 17978U}) {
    const auto scene = test::random_refinement(seed);
    ASSERT_NE(scene, nullptr) << seed;
    scene->parameters.risk.threshold = 20000.0F;  // they were found with
    RefinementResult result;
    const Trajectory refined = refined_of(*scene, {kPasses, kEvaluations}, result);
    EXPECT_FALSE(result.improved) << seed;
    EXPECT_TRUE(same(refined, scene->trajectory)) << seed;
  }
}

// CAND-014: across, in the lane it is 0.3 m from the centre or as far as the candidate and 2 cm; a metre from
// the candidate.
TEST(Refinement, IsBoundByLaneOrCandidate) {
  EXPECT_TRUE(rc::check([] {
    const auto scene = arbitrary_scene();
    for (const RefinementStep& step : scene->problem.steps) {
      if (step.across_high_m == 1.0F && step.across_low_m == -1.0F) continue;
      RC_ASSERT(step.across_low_m < 0.0F && step.across_high_m > 0.0F);
      const float offset_m = step.lane_offset_m;  // 0 where the candidate is on its way
      const float low_m = offset_m + step.across_low_m;
      const float high_m = offset_m + step.across_high_m;
      const float most_m = std::max(0.3F, std::abs(offset_m)) + 0.021F;
      RC_ASSERT(low_m >= -most_m && high_m <= most_m);
    }
  }));
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
    RefinementResult result;
    const Trajectory refined = refined_of(*scene, {kPasses, kEvaluations}, result);
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
    RefinementResult result;
    const Trajectory refined = refined_of(*scene, {kPasses, kEvaluations}, result);
    const TrajectoryPoint& there = refined.points[kHorizonSteps];
    RC_ASSERT(there.speed_mps < 0.1F);
    RC_ASSERT(std::abs(to_local(end.rear_axle, position(there.rear_axle)).x_m) < 0.04F);
  }));
}

}  // namespace
}  // namespace s4tp::trajectory
