// Predictive-Decision: what a candidate costs, by hand, and what follows from it.

#include "sim_host/baselines/predictive_decision.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "sim_host/baselines/goal_distance.hpp"
#include "tests/support/first_plan.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::baselines {
namespace {

/// A straight road at a limit of 10 m/s, our rear axle at 20 m, 10 m/s; cars of 5.0 x 1.8 m as told.
struct Road {
  explicit Road(const std::vector<Track>& tracks = {}, int lanes = 1)
      : map(test::straight_road(lanes, 300.0F, 10.0F)),
        ego(test::ego_at(20.0F, 0.0F, 0.0F, 10.0F)),
        scene(test::scene_of(map, ego, tracks)) {
    predictor.encode(scene, parameters, scene.time_ms);
    predictor.constant_velocity(others);
    trajectory::build_reference(map, scene.ego_paths[0].path, 20.0F, 10.0F, parameters, line);
  }
  /// Every vehicle as "keeps doing what it does", which is easy to work out by hand.
  [[nodiscard]] PdCost cost_of(const Trajectory& trajectory, int path = 0) const {
    return pd_features(scene, path, line, trajectory, satp::PredictionSet{}, others, parameters);
  }
  LaneMap map;
  EgoState ego;
  Parameters parameters;
  scene::Scene scene;
  satp::Predictor predictor;
  satp::KinematicSet others;
  trajectory::ReferenceLine line;
};

// 1 * 0.1 + 0.5 * 0.2 + 0.1 * 0.3 + 0.1 * 0.4 + 1 * 0.5 + 5 * 0.6 + 10 * 0.7 = 10.77.
TEST(PredictiveDecision, WeighsAsPublished) {
  EXPECT_NEAR(weighted({0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F, 0.7F}, kPdWeights), 10.77F, 1e-4F);
}

// Alone, at the limit: 30 m of 30 m driven, no deviation of speed, nobody near. Nothing costs.
TEST(PredictiveDecision, DrivingOnAnEmptyRoadCostsNothing) {
  const Road road;
  EXPECT_NEAR(weighted(road.cost_of(test::plan_of(road.ego)), kPdWeights), 0.0F, 1e-3F);
}

// Braking with 2 m/s^2: 10 * 3 - 2 * 9 / 2 = 21 m, so 9 m of 30 m are lacking: 0.3. Speed is t * 2 below,
// from 0.1 s to 3 s: mean 2 * 1.55 = 3.1 of 10 m/s. The first step's jump of 2 m/s^2 stands at t = 0 already,
// so no jerk. 0.3 + 0.5 * 0.31 = 0.455.
TEST(PredictiveDecision, BrakingCostsWayAndSpeed) {
  const Road road;
  const PdCost cost = road.cost_of(test::plan_of(road.ego, -2.0F));
  EXPECT_NEAR(cost.goal, 0.3F, 1e-3F);
  EXPECT_NEAR(cost.speed, 0.31F, 1e-3F);
  EXPECT_NEAR(cost.jerk, 0.0F, 1e-4F);
  EXPECT_NEAR(weighted(cost, kPdWeights), 0.455F, 2e-3F);
}

// A car stands 20 m ahead of our bumper (rear at 44 m): on at 10 m/s is a collision (10), with a time to
// collision of 0 once there (5). Braking with 3 m/s^2 comes to 20 + 16.5 + 4 = 40.5 m at 1 m/s: 3.5 m
// gap, 3.5 s away. On its way the least time to collision is that of a plan step: after 0.9 s, 7.3 m/s and 20
// - 7.785 = 12.2 m: 1.67 s; after 1.9 s, 4.3 m/s, 6.4 m: 1.49 s; after 1.4 s 5.8 m/s, 8.9 m: 1.54 s;
// after 2.4 s 2.8 m/s, 4.6 m: 1.66 s.
TEST(PredictiveDecision, CollisionAndTimeToItWeighMost) {
  const Road road({test::car(1, 46.5F, 0.0F, 0.0F, 0.0F)});
  const PdCost on = road.cost_of(test::plan_of(road.ego));
  EXPECT_FLOAT_EQ(on.collision, 1.0F);
  EXPECT_FLOAT_EQ(on.ttc, 1.0F);
  const PdCost brakes = road.cost_of(test::plan_of(road.ego, -3.0F));
  EXPECT_FLOAT_EQ(brakes.collision, 0.0F);
  EXPECT_NEAR(brakes.ttc, 1.0F - 1.49F / 3.0F, 0.02F);
  EXPECT_GT(weighted(on, kPdWeights), 15.0F);
  EXPECT_LT(weighted(brakes, kPdWeights), 4.0F);
}

// Side by side with somebody as fast, 3.2 m apart: a gap of 1.4 m all the time, exp(-1.4) = 0.2466.
TEST(PredictiveDecision, KeepsItsDistance) {
  const Road road({test::car(1, 21.5F, 3.2F, 0.0F, 10.0F)}, 2);
  const PdCost cost = road.cost_of(test::plan_of(road.ego));
  EXPECT_NEAR(cost.distance, 0.2466F, 2e-3F);
  EXPECT_FLOAT_EQ(cost.collision, 0.0F);
}

// A lane change still due counts as the 3 s at the limit that it takes, 30 m of 30 m. From 10 m/s, 54 m with the front, 10^2 / (2 * 2.5)
// = 20 m to a standstill and 15 m for the change need the lane until 89 m: where it ends at 80 m the missed goal counts
// by 9 m of 15 m, and whole where it ends at 70 m; braking with 3 m/s^2 it comes to 40.5 m with 1 m/s and misses nothing.
TEST(PredictiveDecision, ALaneChangeStillDueCostsWayAndMoreWhenItIsTooLate) {
  Road road({}, 2);
  const Trajectory on = test::plan_of(road.ego);
  const Trajectory brakes = test::plan_of(road.ego, -3.0F);
  road.scene.ego_paths[0].changes_needed = 1;
  EXPECT_NEAR(road.cost_of(on).goal, 1.0F, 1e-3F);
  const float in_time = road.cost_of(brakes).goal;
  const auto ends_at = [&](float s_m) {
    road.scene.ego_paths[0].route_end_s_m = s_m;
    road.scene.ego_paths[0].change_by_s_m.clear();
    ASSERT_TRUE(road.scene.ego_paths[0].change_by_s_m.push(s_m));
  };
  ends_at(80.0F);
  EXPECT_NEAR(road.cost_of(on).goal, 1.0F + kMissed * 9.0F / 15.0F, 0.05F);
  EXPECT_NEAR(road.cost_of(brakes).goal, in_time, 1e-3F);
  ends_at(70.0F);
  EXPECT_NEAR(road.cost_of(on).goal, 1.0F + kMissed, 1e-3F);
  EXPECT_NEAR(road.cost_of(brakes).goal, in_time, 1e-3F);
}

// A goal that is missed is worse than the least time to collision, and less bad than a collision.
TEST(PredictiveDecision, AMissedGoalLiesBetweenDangerAndCollision) {
  EXPECT_GT(kMissed * kPdWeights.goal, kPdWeights.ttc);
  EXPECT_LT(kMissed * kPdWeights.goal, kPdWeights.collision);
}

// Our lane ends at 50 m, where our front is after 2.6 s; the one on the left goes on. Whoever is in that by then misses nothing; beside
// it all of the change is left to do, and a metre sideways is not enough.
TEST(PredictiveDecision, AChangeHasToBeMadeWhereOurLaneEnds) {
  Road road({}, 2);
  int left = 0;
  while (left < road.scene.ego_paths.size() &&
         road.scene.ego_paths[left].manoeuvre != scene::Manoeuvre::kLeft)
    ++left;
  ASSERT_LT(left, road.scene.ego_paths.size());
  road.scene.ego_paths[0].changes_needed = 1;
  road.scene.ego_paths[0].route_end_s_m = 50.0F;
  const auto beside = [&](float d_m) {
    Trajectory motion = test::plan_of(road.ego);
    for (TrajectoryPoint& point : motion.points) point.rear_axle.y_m += d_m;
    return goal_distance(road.scene, road.scene.ego_paths[left], motion, road.parameters);
  };
  EXPECT_NEAR(beside(3.2F), 0.0F, 1e-3F);
  EXPECT_GT(beside(1.0F), 0.3F * kMissed);
  EXPECT_GT(beside(0.0F), 1.0F + 0.9F * kMissed);
}

// Behind a standing car the planner itself brakes, bare as well: the cost says so, no rule.
TEST(PredictiveDecision, StopsForAStandingCar) {
  const LaneMap map = test::straight_road(1, 300.0F);
  const Plan plan = test::first_plan<PredictiveDecisionPlanner<false, true>>(
      map, test::ego_at(20.0F, 0.0F, 0.0F, 10.0F), test::car(1, 46.5F, 0.0F, 0.0F, 0.0F));
  EXPECT_LT(plan.trajectory.points[kHorizonSteps].rear_axle.x_m, 40.0F);  // its rear is at 44 m
}

}  // namespace
}  // namespace s4tp::baselines
