#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/networks.hpp"

namespace s4tp::map {
namespace {

using test::lane;
using test::shipped;

const RouteGuide::Advice& advice(const scenario::Scenario& scenario, const RouteGuide& guide,
                                 const char* name) {
  return guide.advice(scenario.network.find(name));
}

// South arm 29.6 m, turn 16.80 m, exit 42.80 m: 89.2 m to the goal from the arm's start, no change before the
// exit; there one to the right, due by its end.
TEST(RouteGuide, TheLeftTurnNeedsOneChangeAtTheEnd) {
  const scenario::Scenario scenario = shipped("left_turn");
  const RouteGuide guide = scenario::mission_guide(scenario);
  const RouteGuide::Advice& arm = advice(scenario, guide, "south_in_0");
  EXPECT_TRUE(arm.on_route);
  EXPECT_EQ(arm.changes_needed, 0);
  EXPECT_EQ(arm.next, scenario.network.find(":centre_9_0"));
  EXPECT_NEAR(arm.goal_distance_m, 89.2, 0.01);
  EXPECT_NEAR(arm.remaining_m, 89.2, 0.01);
  const RouteGuide::Advice& inner = advice(scenario, guide, "west_out_1");
  EXPECT_EQ(inner.changes_needed, -1);
  EXPECT_NEAR(inner.remaining_m, 42.8, 0.01);
  EXPECT_EQ(advice(scenario, guide, "west_out_0").changes_needed, 0);
  EXPECT_FALSE(advice(scenario, guide, ":centre_8_0").on_route);
  EXPECT_FALSE(advice(scenario, guide, "east_in_0").on_route);
}

// The acceleration lane ends after 71 m, the goal is three lanes further left: 3 changes, the first due
// within 71 m. One lane to the left it is 2, due within 71 + 1 + 70 m.
TEST(RouteGuide, TheMergeNeedsThreeChanges) {
  const scenario::Scenario scenario = shipped("merge");
  const RouteGuide guide = scenario::mission_guide(scenario);
  EXPECT_EQ(advice(scenario, guide, "merge_0").changes_needed, 3);
  EXPECT_NEAR(advice(scenario, guide, "merge_0").remaining_m, 71.0, 0.01);
  EXPECT_EQ(advice(scenario, guide, "merge_0").next, kNoLane);
  EXPECT_NEAR(advice(scenario, guide, "merge_0").goal_distance_m, 142.0, 0.01);
  EXPECT_EQ(advice(scenario, guide, "merge_1").changes_needed, 2);
  EXPECT_NEAR(advice(scenario, guide, "merge_1").remaining_m, 142.0, 0.01);
  EXPECT_EQ(advice(scenario, guide, "merge_3").changes_needed, 0);
  EXPECT_EQ(advice(scenario, guide, ":lane_end_0_0").changes_needed, 2);
  EXPECT_EQ(advice(scenario, guide, "ramp_0").changes_needed, 0);
  EXPECT_FALSE(advice(scenario, guide, "main_in_0").on_route);
}

// Without a goal lane any will do: nobody on the last edge has to change.
TEST(RouteGuide, WithoutAGoalLaneAnyWillDo) {
  const scenario::Scenario scenario = shipped("merge");
  const RouteGuide guide(scenario.network, {"main_in", "merge", "main_out"}, kNoLane, 70.0);
  EXPECT_EQ(advice(scenario, guide, "main_out_0").changes_needed, 0);
  EXPECT_EQ(advice(scenario, guide, "merge_1").changes_needed, 0);
  EXPECT_EQ(advice(scenario, guide, "merge_0").changes_needed, 1);
  EXPECT_EQ(advice(scenario, guide, "main_in_2").changes_needed, 0);
}

// The main road's right turn starts in the right lane: who is in the left one must change there, within 80 m.
TEST(RouteGuide, ATurnIsPreparedOnTheEdgeBefore) {
  const scenario::Scenario scenario = shipped("left_turn");
  const RouteGuide guide(scenario.network, {"west_in", "south_out"}, kNoLane, 29.6);
  EXPECT_EQ(advice(scenario, guide, "west_in_1").changes_needed, -1);
  EXPECT_NEAR(advice(scenario, guide, "west_in_1").remaining_m, 80.0, 0.01);
  EXPECT_EQ(advice(scenario, guide, "west_in_0").next, scenario.network.find(":centre_10_0"));
}

// A goal half way along a lane counts from there: 60 m from the start of a lane of 200 m.
TEST(RouteGuide, TheGoalMayLieHalfWay) {
  const scenario::Scenario scenario = shipped("cruise");
  const RouteGuide guide(scenario.network, {"road"}, scenario.network.find("road_1"), 60.0);
  EXPECT_DOUBLE_EQ(advice(scenario, guide, "road_1").goal_distance_m, 60.0);
  EXPECT_EQ(advice(scenario, guide, "road_0").changes_needed, 1);
  EXPECT_DOUBLE_EQ(advice(scenario, guide, "road_0").remaining_m, 60.0);
}

// A way through the left turn that waits inside the junction: both parts belong to the route and add up.
TEST(RouteGuide, GoesThroughJunctionLanesInTwoParts) {
  const scenario::Scenario scenario = shipped("left_turn");
  const RouteGuide guide(scenario.network, {"east_in", "south_out"}, kNoLane, 29.6);
  const RouteGuide::Advice& waiting = advice(scenario, guide, ":centre_6_0");
  EXPECT_TRUE(waiting.on_route);
  EXPECT_EQ(waiting.next, scenario.network.find(":centre_14_0"));
  EXPECT_NEAR(waiting.goal_distance_m, 16.8 + 29.6, 0.01);
}

// NET-003 Edges that do not lead to each other, unknown ones and a goal elsewhere are refused.
TEST(RouteGuide, RefusesRoutesThatDoNotExist) {
  const Network network = shipped("left_turn").network;
  EXPECT_THROW(RouteGuide(network, {"south_in", "south_out"}, kNoLane, 0.0), std::runtime_error);
  EXPECT_THROW(RouteGuide(network, {"south_in", "moon"}, kNoLane, 0.0), std::runtime_error);
  EXPECT_THROW(RouteGuide(network, {}, kNoLane, 0.0), std::runtime_error);
  EXPECT_THROW(RouteGuide(network, {"south_in"}, network.find("west_out_0"), 0.0), std::runtime_error);
}

}  // namespace
}  // namespace s4tp::map
