// Static DRF: the same planner in a world where every other vehicle stands.

#include "sim_host/baselines/static_drf.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::baselines {
namespace {

/// Keeps what the planner believed of the first vehicle.
class Beliefs : public planner::Probe {
 public:
  void stage_begin(planner::Stage) override {}
  void stage_end(planner::Stage) override {}
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile&) override {
    track = scene.agents[0].track;
    modes = prediction.agents[0].modes;
  }
  Track track;
  BoundedVector<satp::Mode, kMaxModes> modes;
};

/// On the minor road of a cross junction, 20 m before it, at 6 m/s; one car on the main road.
struct Junction {
  Junction() : cross(test::cross_junction()) {
    input.map = &cross.map;
    input.start_ms = 100;
    input.ego = test::ego_at(-28.0F, -1.6F, 0.0F, 6.0F);
  }
  test::CrossJunction cross;
  planner::PlannerInput input;
};

template <class PlannerT>
Plan plan_of(const planner::PlannerInput& input, Beliefs& beliefs) {
  auto planner = std::make_unique<PlannerT>();
  EXPECT_EQ(planner->init(Parameters{}), Status::kOk);
  planner->probe = &beliefs;
  Plan plan;
  planner::Explanation explanation;
  EXPECT_EQ(planner->plan(input, plan, explanation), Status::kOk);
  return plan;
}

// A car crosses at 10 m/s from 20 m before the box: s4tp sees it 30 m further on after 3 s, static DRF where
// it is now, in its only future.
TEST(StaticDrf, ACrossingCarIsNotAnticipated) {
  Junction junction;
  (void)junction.input.tracks.push(test::car(1, 1.6F, -28.0F, 1.5708F, 10.0F));
  Beliefs moving;
  (void)plan_of<planner::Planner>(junction.input, moving);
  EXPECT_NEAR(moving.modes[0].steps[kHorizonSteps - 1].y_m, 2.0F, 8.0F);
  Beliefs frozen;
  (void)plan_of<StaticDrfPlanner<true>>(junction.input, frozen);
  ASSERT_EQ(frozen.modes.size(), 1);
  for (const Pose& step : frozen.modes[0].steps) {
    EXPECT_EQ(step.x_m, 1.6F);
    EXPECT_EQ(step.y_m, -28.0F);
  }
}

// Who stands before the junction, and whom the predictor would let start, stays as well.
TEST(StaticDrf, NobodyStarts) {
  Junction junction;
  (void)junction.input.tracks.push(test::car(1, 1.6F, -12.0F, 1.5708F, 0.0F));
  Beliefs starting;
  (void)plan_of<planner::Planner>(junction.input, starting);
  EXPECT_GT(starting.modes[0].steps[kHorizonSteps - 1].y_m, -11.0F);
  Beliefs frozen;
  (void)plan_of<StaticDrfPlanner<false>>(junction.input, frozen);
  EXPECT_EQ(frozen.modes[0].steps[kHorizonSteps - 1].y_m, -12.0F);
}

// The plan is the same to the bit whether the car drives or stands; s4tp's is not.
TEST(StaticDrf, SpeedOfOthersChangesNothing) {
  const auto differs = [](auto planner) {
    Beliefs beliefs;
    Trajectory trajectories[2];
    for (int moving = 0; moving < 2; ++moving) {
      Junction junction;
      const float speed_mps = moving == 1 ? 10.0F : 0.0F;
      (void)junction.input.tracks.push(test::car(1, 1.6F, -28.0F, 1.5708F, speed_mps));
      trajectories[moving] = plan_of<typename decltype(planner)::type>(junction.input, beliefs).trajectory;
    }
    return std::memcmp(&trajectories[0], &trajectories[1], sizeof(Trajectory)) != 0;
  };
  EXPECT_TRUE(differs(std::type_identity<planner::Planner>{}));
  EXPECT_FALSE(differs(std::type_identity<StaticDrfPlanner<false>>{}));
  EXPECT_FALSE(differs(std::type_identity<StaticDrfPlanner<true>>{}));
}

// A track 200 ms old of a car at 10 m/s: it is frozen 2 m further on, where it is now.
TEST(StaticDrf, FreezesThePresentPose) {
  Junction junction;
  (void)junction.input.tracks.push(test::car(1, 1.6F, -28.0F, 1.5708F, 10.0F));
  junction.input.tracks_ms = 1000;
  junction.input.now_ms = 1200;
  junction.input.start_ms = 1300;
  Beliefs beliefs;
  (void)plan_of<StaticDrfPlanner<true>>(junction.input, beliefs);
  EXPECT_NEAR(beliefs.modes[0].steps[0].y_m, -26.0F, 0.05F);
  EXPECT_EQ(beliefs.track.speed_mps, 0.0F);
}

}  // namespace
}  // namespace s4tp::baselines
