#include "algo/satp/predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::satp {
namespace {

using test::CrossJunction;

struct Predicted {
  scene::Scene scene;
  Predictor predictor;
  PredictionSet set;
  KinematicSet constant_velocity;

  const AgentPrediction& of(int id) const {
    for (const AgentPrediction& agent : set.agents) {
      if (scene.agents[agent.agent].track.id == id) return agent;
    }
    ADD_FAILURE() << "vehicle " << id << " is not predicted";
    return set.agents[0];
  }
};

/// Predictions 100 ms after the scene.
void predict(const LaneMap& map, const EgoState& ego, const std::vector<Track>& tracks,
             const Trajectory* plan, Predicted& result, std::uint32_t lead_ms = 100) {
  static const Parameters parameters;
  result.scene = test::scene_of(map, ego, tracks, parameters, 1000);
  result.predictor.encode(result.scene, parameters, 1000 + lead_ms);
  result.predictor.decode(plan, kMaxPredictionWork, result.set);
  result.predictor.constant_velocity(result.constant_velocity);
}

constexpr int kLast = kHorizonSteps - 1;

// CORE-041 The test. We drive 10 m/s, a follower 14 m/s in the left lane, its box centre 20 m behind
// ours. Entering its lane costs it at least 2 m/s within 3 s; staying in ours costs it nothing.
TEST(Predictor, FollowerBrakesForThePlanThatEntersItsLane) {
  const LaneMap map = test::straight_road(2, 400.0F);
  const EgoState ego = test::ego_at(100.0F, 0.0F, 0.0F, 10.0F);
  const std::vector<Track> tracks = {test::car(1, 101.5F - 20.0F, test::kLaneWidthM, 0.0F, 14.0F)};
  Predicted result;
  const Trajectory stays = test::plan_of(ego);
  predict(map, ego, tracks, &stays, result);
  EXPECT_GT(test::predicted_speed(result.of(1).modes[0], kLast), 13.5F);
  const Trajectory enters = test::plan_of(ego, 0.0F, test::kLaneWidthM);
  predict(map, ego, tracks, &enters, result);
  EXPECT_TRUE(result.set.conditioned);
  EXPECT_LT(test::predicted_speed(result.of(1).modes[0], kLast), 12.0F);
}

// CORE-041 The same at equal speeds of 13.89 m/s: a gap of 15 m is short for 1.3 s of headway (20.6 m).
TEST(Predictor, FollowerOpensTheGapAtEqualSpeed) {
  const LaneMap map = test::straight_road(2, 400.0F);
  const EgoState ego = test::ego_at(100.0F, 0.0F, 0.0F, 13.89F);
  const std::vector<Track> tracks = {test::car(1, 101.5F - 20.0F, test::kLaneWidthM, 0.0F, 13.89F)};
  Predicted result;
  const Trajectory enters = test::plan_of(ego, 0.0F, test::kLaneWidthM);
  predict(map, ego, tracks, &enters, result);
  float slowest_mps = 100.0F;
  for (int i = 1; i < kHorizonSteps; ++i) {
    slowest_mps = std::min(slowest_mps, test::predicted_speed(result.of(1).modes[0], i));
  }
  EXPECT_LT(slowest_mps, 13.89F - 2.0F);
}

// CORE-042 Without plan nobody in the next lane brakes for us, and who follows us already does when we are
// slow.
TEST(Predictor, WithoutPlanOnlyThoseWeAreInTheWayOfReact) {
  const LaneMap map = test::straight_road(2, 400.0F);
  const EgoState ego = test::ego_at(100.0F, 0.0F, 0.0F, 5.0F);
  Predicted result;
  predict(map, ego,
          {test::car(1, 75.0F, test::kLaneWidthM, 0.0F, 13.0F), test::car(2, 75.0F, 0.0F, 0.0F, 13.0F)},
          nullptr, result);
  EXPECT_FALSE(result.set.conditioned);
  EXPECT_GT(test::predicted_speed(result.of(1).modes[0], kLast), 12.9F);
  EXPECT_LT(test::predicted_speed(result.of(2).modes[0], kLast), 10.0F);
}

// 100 ms from scene to plan start: step 0 is 200 ms after the scene, 13 m/s * 0.2 s = 2.6 m on.
TEST(Predictor, CountsFromPlanStart) {
  const LaneMap map = test::straight_road(2, 400.0F, 13.0F);
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 5.0F), {test::car(1, 100.0F, test::kLaneWidthM, 0.0F, 13.0F)},
          nullptr, result);
  EXPECT_NEAR(result.of(1).modes[0].steps[0].x_m, 102.6F, 0.02F);
  EXPECT_NEAR(result.constant_velocity.agents[0].steps[0].x_m, 102.6F, 1e-3F);
  EXPECT_NEAR(result.constant_velocity.agents[0].steps[kLast].x_m, 100.0F + 13.0F * 3.1F, 1e-2F);
}

// A car at 14 m/s comes up behind one at 6 m/s, 30 m ahead: it ends slower, and behind.
TEST(Predictor, FollowsItsLeader) {
  const LaneMap map = test::straight_road(2, 400.0F);
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 5.0F),
          {test::car(1, 60.0F, test::kLaneWidthM, 0.0F, 14.0F),
           test::car(2, 90.0F, test::kLaneWidthM, 0.0F, 6.0F)},
          nullptr, result);
  const Mode& follower = result.of(1).modes[0];
  const Mode& leader = result.of(2).modes[0];
  EXPECT_LT(test::predicted_speed(follower, kLast), 10.0F);
  EXPECT_GT(leader.steps[kLast].x_m - follower.steps[kLast].x_m, 5.0F);
}

// Two cars 1 s apart at the same speed stay so: nobody brakes for the textbook's headway.
TEST(Predictor, KeepsTheHeadwayItHas) {
  const LaneMap map = test::straight_road(1, 400.0F, 12.0F);
  Predicted result;
  predict(map, test::ego_at(300.0F, 0.0F, 0.0F, 12.0F),
          {test::car(1, 60.0F, 0.0F, 0.0F, 12.0F), test::car(2, 77.0F, 0.0F, 0.0F, 12.0F)}, nullptr, result);
  EXPECT_GT(test::predicted_speed(result.of(1).modes[0], kLast), 9.5F);
}

// A quarter circle of radius 9.6 m allows sqrt(4 * 9.6) = 6.2 m/s.
TEST(Predictor, SlowsDownForATurn) {
  LaneMap map;
  const LaneIndex before = test::add_lane(map, {{-50.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex turn = test::add_lane(map, test::arc({0.0F, 0.0F, 0.0F}, 9.6F, 1.5708F, 12));
  test::link(map, before, turn);
  Predicted result;
  predict(map, test::ego_at(-45.0F, 0.0F, 0.0F, 5.0F), {test::car(1, -15.0F, 0.0F, 0.0F, 9.0F)}, nullptr,
          result);
  EXPECT_NEAR(test::predicted_speed(result.of(1).modes[0], kLast), 6.2F, 0.5F);
}

// Before a junction: three ways, three modes, their chances add up to 1, the likeliest first.
TEST(Predictor, OneModeForEachWay) {
  const CrossJunction cross = test::cross_junction();
  Predicted result;
  predict(cross.map, test::ego_at(-58.0F, -1.6F, 0.0F, 1.0F), {test::car(1, 1.6F, -18.0F, 1.5708F, 6.0F)},
          nullptr, result);
  const AgentPrediction& agent = result.of(1);
  ASSERT_EQ(agent.modes.size(), 3);
  float sum = 0.0F;
  for (const Mode& mode : agent.modes) sum += mode.probability;
  EXPECT_NEAR(sum, 1.0F, 1e-5F);
  EXPECT_GE(agent.modes[0].probability, agent.modes[1].probability);
}

/// The cross junction where who enters heading `h` can only go straight on.
CrossJunction straight_only(int h) {
  CrossJunction cross = test::cross_junction();
  Lane& lane = cross.map.lanes[cross.in[h]];
  lane.successors[1] = lane.successors[2] = kNoLaneIndex;
  return cross;
}

// A car on the minor road, 20 m before the crossing, yields to us on the main road: its front stays out of
// our lane, whose edge is at x = 0.
TEST(Predictor, WhoMustYieldWaitsForUs) {
  const CrossJunction cross = straight_only(CrossJunction::kEast);
  const EgoState ego = test::ego_at(1.6F, -40.0F, 1.5708F, 12.0F);
  Predicted result;
  predict(cross.map, ego, {test::car(1, -28.0F, -1.6F, 0.0F, 7.0F)}, nullptr, result);
  ASSERT_EQ(result.of(1).modes.size(), 1);
  EXPECT_EQ(result.of(1).modes[0].yields_percent, 100);
  EXPECT_LT(result.of(1).modes[0].steps[kLast].x_m + 2.5F, 0.0F);
}

// A car on the main road goes on where we, on the minor one, only come up to the line; if we cut in front of
// it all the same, some of its futures brake for us and some do not: braking from 13 m/s within 35 m takes
// 2.4 m/s^2, more than everybody does for who has no right of way.
TEST(Predictor, WhoHasPriorityMayOrMayNotBrakeForUs) {
  const CrossJunction cross = straight_only(CrossJunction::kNorth);
  const EgoState ego = test::ego_at(-16.0F, -1.6F, 0.0F, 6.0F);
  const std::vector<Track> tracks = {test::car(1, 1.6F, -42.0F, 1.5708F, 13.0F)};
  Predicted result;
  const Trajectory stops = test::plan_of(ego, -3.0F);
  predict(cross.map, ego, tracks, &stops, result);
  ASSERT_EQ(result.of(1).modes.size(), 1);
  EXPECT_EQ(result.of(1).modes[0].yields_percent, 0);
  EXPECT_GT(test::predicted_speed(result.of(1).modes[0], kLast), 12.5F);
  const Trajectory crosses = test::plan_of(ego, 1.0F);
  predict(cross.map, ego, tracks, &crosses, result);
  ASSERT_EQ(result.of(1).modes.size(), 2);
  EXPECT_NE(result.of(1).modes[0].yields_percent, result.of(1).modes[1].yields_percent);
}

// CORE-043 Off the map the arc goes on: 10 m/s and 0.5 rad/s for 3 s turn it by 1.5 rad.
TEST(Predictor, OffTheMapTheArcGoesOn) {
  const LaneMap map = test::straight_road(1, 100.0F);
  Track track = test::car(1, 0.0F, 60.0F, 0.0F, 10.0F);
  track.yaw_rate_radps = 0.5F;
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 5.0F), {track}, nullptr, result, 0);
  EXPECT_NEAR(result.constant_velocity.agents[0].steps[kLast].heading_rad, 1.5F, 1e-3F);
  EXPECT_NEAR(result.constant_velocity.agents[0].steps[kLast].x_m, 20.0F * std::sin(1.5F), 0.05F);
  ASSERT_EQ(result.of(1).modes.size(), 1);
  EXPECT_FLOAT_EQ(result.of(1).modes[0].probability, 1.0F);
}

// A car standing with nothing in its way has a reason: it is not predicted to start.
TEST(Predictor, WhoStandsWithoutReasonGoesOnStanding) {
  const LaneMap map = test::straight_road(1, 200.0F);
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 10.0F), {test::car(1, 60.0F, 0.0F, 0.0F, 0.0F)}, nullptr,
          result);
  EXPECT_NEAR(result.of(1).modes[0].steps[kLast].x_m, 60.0F, 0.01F);
}

// Half way through a lane change at 12 m/s: it ends on the new lane's centre, and constant_velocity says so too.
TEST(Predictor, FinishesALaneChange) {
  const LaneMap map = test::straight_road(2, 300.0F, 12.0F);
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 5.0F), {test::car(1, 60.0F, 1.2F, 0.08F, 12.0F)}, nullptr,
          result);
  EXPECT_NEAR(result.of(1).modes[0].steps[kLast].y_m, test::kLaneWidthM, 0.1F);
  EXPECT_NEAR(result.constant_velocity.agents[0].steps[kLast].y_m, test::kLaneWidthM, 0.1F);
}

// Work is counted in agent-mode-steps: one vehicle, one mode, 30 steps; constant_velocity the same again.
TEST(Predictor, CountsItsWork) {
  const LaneMap map = test::straight_road(1, 200.0F);
  Predicted result;
  predict(map, test::ego_at(10.0F, 0.0F, 0.0F, 5.0F), {test::car(1, 60.0F, 0.0F, 0.0F, 8.0F)}, nullptr,
          result);
  EXPECT_EQ(result.predictor.work(), 2 * kHorizonSteps);
}

}  // namespace
}  // namespace s4tp::satp
