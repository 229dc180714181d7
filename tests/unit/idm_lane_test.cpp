// The plain driver: the intelligent driver model, gaps at junctions and beside.

#include "sim_host/baselines/idm_lane.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::baselines {
namespace {

const IdmDriver kDriver;

// At rest a = 2.6; at half the wanted speed 2.6 (1 - 1/16) = 2.4375; at it 0; far above never below -b = -2.
TEST(IdmLane, AcceleratesOnAFreeRoad) {
  EXPECT_FLOAT_EQ(idm_free(kDriver, 0.0F, 14.0F), 2.6F);
  EXPECT_FLOAT_EQ(idm_free(kDriver, 7.0F, 14.0F), 2.4375F);
  EXPECT_FLOAT_EQ(idm_free(kDriver, 14.0F, 14.0F), 0.0F);
  EXPECT_FLOAT_EQ(idm_free(kDriver, 28.0F, 14.0F), -2.0F);
}

// Behind a leader as fast, 10 m/s: s* = 2.5 + 10 * 1 = 12.5 m. At that gap 0, at 25 m 2.6 (1 - 1/4) = 1.95.
// 5 m/s faster than the leader: s* grows by 10 * 5 / (2 sqrt(2.6 * 2)) = 10.964 m.
TEST(IdmLane, KeepsItsGap) {
  EXPECT_NEAR(idm_behind(kDriver, 10.0F, 12.5F, 10.0F), 0.0F, 1e-5F);
  EXPECT_NEAR(idm_behind(kDriver, 10.0F, 25.0F, 10.0F), 1.95F, 1e-5F);
  EXPECT_NEAR(idm_behind(kDriver, 10.0F, 23.464F, 5.0F), 0.0F, 1e-3F);
  // A faster leader asks for no more than the standstill gap: 2.5 m at 2.5 m.
  EXPECT_NEAR(idm_behind(kDriver, 10.0F, 2.5F, 30.0F), 0.0F, 1e-5F);
}

// We would be in the zone from 2 s to 6 s. Where we yield the other one may come from 7 s on, 1 s after us.
TEST(IdmLane, AcceptsAndRefusesGaps) {
  EXPECT_TRUE(gap_accepted({7.1F, 9.0F, Priority::kFirstYields, true}, 2.0F, 6.0F, 1.0F));
  EXPECT_FALSE(gap_accepted({6.9F, 9.0F, Priority::kFirstYields, true}, 2.0F, 6.0F, 1.0F));
  EXPECT_TRUE(
      gap_accepted({0.5F, 1.6F, Priority::kFirstYields, true}, 2.0F, 6.0F, 1.0F));  // gone 0.4 s before
  EXPECT_FALSE(gap_accepted({0.5F, 1.8F, Priority::kFirstYields, true}, 2.0F, 6.0F, 1.0F));
}

// With right of way, or as the first to come, we go, unless the other one can no longer stop or is there already.
TEST(IdmLane, InsistsOnItsRightOfWayOnlyWhereThatIsSafe) {
  EXPECT_TRUE(gap_accepted({3.0F, 5.0F, Priority::kFirstHasPriority, true}, 2.0F, 6.0F, 1.0F));
  EXPECT_FALSE(gap_accepted({3.0F, 5.0F, Priority::kFirstHasPriority, false}, 2.0F, 6.0F, 1.0F));
  EXPECT_FALSE(gap_accepted({0.0F, 5.0F, Priority::kFirstHasPriority, true}, 2.0F, 6.0F, 1.0F));
  EXPECT_TRUE(gap_accepted({2.1F, 5.0F, Priority::kFirstCome, true}, 2.0F, 6.0F, 1.0F));
  EXPECT_FALSE(gap_accepted({1.9F, 5.0F, Priority::kFirstCome, true}, 2.0F, 6.0F, 1.0F));
}

// At 10 m/s, somebody behind at 15 m/s: s* = 2.5 + 15 + 15 * 5 / 4.561 = 33.95 m. It brakes with 3 m/s^2 at
// s* / sqrt(1 + 3 / 2.6) = 23.13 m: a change is accepted above that gap.
TEST(IdmLane, AsksLittleOfTheOneBehind) {
  const trajectory::Leader nobody;
  EXPECT_TRUE(change_accepted(kDriver, 10.0F, nobody, nobody));
  EXPECT_TRUE(change_accepted(kDriver, 10.0F, nobody, {0, 23.3F, 15.0F, 0.0F}));
  EXPECT_FALSE(change_accepted(kDriver, 10.0F, nobody, {0, 22.9F, 15.0F, 0.0F}));
  EXPECT_FALSE(change_accepted(kDriver, 10.0F, {0, -1.0F, 10.0F, 0.0F}, nobody));  // beside us
}

Trajectory plan_of(const LaneMap& map, const EgoState& ego, const std::vector<Track>& tracks) {
  auto planner = std::make_unique<IdmLanePlanner>();
  EXPECT_EQ(planner->init(Parameters{}), Status::kOk);
  planner::PlannerInput input;
  input.map = &map;
  input.start_ms = 100;
  input.ego = ego;
  input.tracks = test::track_list(tracks);
  Plan plan;
  planner::Explanation explanation;
  EXPECT_EQ(planner->plan(input, plan, explanation), Status::kOk);
  EXPECT_TRUE(trajectory::feasible(plan.trajectory, Parameters{}));
  return plan.trajectory;
}

float end_x_m(const Trajectory& trajectory) {
  return trajectory.points[kHorizonSteps].rear_axle.x_m;
}

// From the minor road, 28 m before the middle at 6 m/s. Alone it drives on; a car on the main road that is
// there in 3 s is let pass: the front (4 m ahead of the rear axle) stays before the stop line at -8.5 m.
TEST(IdmLane, GivesWayAtAJunction) {
  test::CrossJunction cross = test::cross_junction();
  test::set_route(cross, test::CrossJunction::kEast, test::CrossJunction::kStraight);
  const EgoState ego = test::ego_at(-28.0F, -1.6F, 0.0F, 6.0F);
  EXPECT_GT(end_x_m(plan_of(cross.map, ego, {})), -12.5F);
  const Trajectory waits = plan_of(cross.map, ego, {test::car(1, 1.6F, -40.0F, 1.5708F, 10.0F)});
  EXPECT_LT(end_x_m(waits), -12.5F);
  EXPECT_LT(waits.points[kHorizonSteps].speed_mps, 3.0F);
}

// The route needs the left lane: free, it goes there; a car right beside keeps it in its own.
TEST(IdmLane, ChangesLaneIntoAGapOnly) {
  LaneMap map = test::straight_road(2, 300.0F);
  map.lanes[0].changes_needed = 1;
  const EgoState ego = test::ego_at(20.0F, 0.0F, 0.0F, 10.0F);
  const Trajectory free = plan_of(map, ego, {});
  EXPECT_GT(free.points[kHorizonSteps].rear_axle.y_m, 2.0F);
  const Trajectory kept = plan_of(map, ego, {test::car(1, 21.0F, 3.2F, 0.0F, 10.0F)});
  EXPECT_NEAR(kept.points[kHorizonSteps].rear_axle.y_m, 0.0F, 0.01F);
}

// 10 m behind somebody at 5 m/s there is room for 2.6 (1 - (7.5 / 10)^2) = 1.14, beside for 2.56 m/s^2: more
// than 1 m/s^2 is gained, and the lane beside taken where there is room to come back.
TEST(IdmLane, OvertakesASlowLeader) {
  LaneMap map = test::straight_road(2, 300.0F);
  map.lanes[1].changes_needed = -1;
  const EgoState ego = test::ego_at(20.0F, 0.0F, 0.0F, 5.0F);
  const Trajectory passes = plan_of(map, ego, {test::car(1, 36.5F, 0.0F, 0.0F, 5.0F)});
  EXPECT_GT(passes.points[kHorizonSteps].rear_axle.y_m, 1.0F);
  map.lanes[0].route_remaining_m = map.lanes[1].route_remaining_m = 120.0F;  // none
  const Trajectory follows = plan_of(map, ego, {test::car(1, 36.5F, 0.0F, 0.0F, 5.0F)});
  EXPECT_NEAR(follows.points[kHorizonSteps].rear_axle.y_m, 0.0F, 0.01F);
}

}  // namespace
}  // namespace s4tp::baselines
