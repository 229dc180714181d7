// What a lane costs beyond the horizon: when overtaking pays, and when there is no time left for it.

#include "algo/planner/lane_cost_to_go.hpp"

#include <gtest/gtest.h>

#include "tests/support/driving_scenes.hpp"

namespace s4tp::planner {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// We are at s = 20, or where it says, of the right of two lanes at 10 m/s, the limit; the goal is at the end of our lane, 300
/// m.
struct Road {
  LaneMap map = straight_road(2, 300.0F, 10.0F);
  scene::Scene scene;
  Parameters parameters;
  LaneCostToGo cost_to_go;

  explicit Road(float start_s_m = 20.0F) {
    add_ego_path(scene, map, path_of(map, {0}));
    add_ego_path(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft).changes_needed = -1;
    put_ego(scene, state_on(map, scene.ego_paths[0].path, start_s_m, 10.0F));
  }
  void vehicle(int path, float s_m, float speed_mps) {
    add_vehicle(scene, map, scene.ego_paths[path].path, s_m, speed_mps);
  }
  void look() {
    satp::KinematicSet constant_velocity;
    for (const scene::Agent& agent : scene.agents)
      (void)constant_velocity.agents.push(steady_future(map, agent));
    cost_to_go.look(scene, constant_velocity, 0.0F, parameters);
  }
};

// With nobody about 150 m at the limit lose nothing, in neither lane.
TEST(LaneCostToGo, EmptyRoadLosesNothing) {
  Road road;
  road.look();
  EXPECT_NEAR(road.cost_to_go.delay_s(0, 50.0F, 10.0F), 0.0F, 0.01F);
  EXPECT_NEAR(road.cost_to_go.delay_s(1, 50.0F, 10.0F), 0.0F, 0.01F);
}

// Who has slowed down to 5 m/s by the horizon's end builds up again at 2 m/s^2: 2.5 s over 18.75 m, which the
// limit drives in 1.875 s: 0.625 s lost, besides what the shorter way to there has lost.
TEST(LaneCostToGo, BuildingUpSpeedCosts) {
  Road road;
  road.look();
  EXPECT_NEAR(road.cost_to_go.delay_s(0, 50.0F, 5.0F), 0.625F, 0.01F);
}

// Our leader drives 5 m/s, its centre at 60 m now. Our centre is at the target of 170 + 1.5 m when its is 5 m
// of lengths, 2.5 m and 1.2 s * 5 m/s further: (171.5 + 13.5 - 75) / 5 = 22 s after the horizon's end. 15 s
// at the limit: 10 s lost. The lane beside loses none: it is passed long before the way back has to begin.
TEST(LaneCostToGo, OvertakingPays) {
  Road road;
  road.vehicle(0, 60.0F, 5.0F);
  road.look();
  EXPECT_NEAR(road.cost_to_go.delay_s(0, 50.0F, 10.0F), 10.0F, 0.05F);
  EXPECT_NEAR(road.cost_to_go.delay_s(1, 50.0F, 10.0F), 0.0F, 0.01F);
}

// One at 9 m/s, 15 m nearer, costs (171.5 + 18.3 - 72) / 9 = 13.1 s: 1.1 s lost. We gain 1 m/s on it: a place
// 37 m further, in front of it, is ours after 37 s and 370 m, where the lane has ended. So the lane beside is as slow as
// ours.
TEST(LaneCostToGo, NoOvertakingWithoutRoomToReturn) {
  Road road;
  road.vehicle(0, 45.0F, 9.0F);
  road.look();
  EXPECT_NEAR(road.cost_to_go.delay_s(0, 50.0F, 10.0F), 1.1F, 0.05F);
  EXPECT_NEAR(road.cost_to_go.delay_s(1, 50.0F, 10.0F), road.cost_to_go.delay_s(0, 50.0F, 10.0F), 0.01F);
}

// Somebody slower in the other lane makes that the worse one.
TEST(LaneCostToGo, TheLaneBesideMayBeSlower) {
  Road road;
  road.vehicle(0, 60.0F, 6.0F);
  road.vehicle(1, 60.0F, 4.0F);
  road.look();
  EXPECT_GT(road.cost_to_go.delay_s(1, 50.0F, 10.0F), road.cost_to_go.delay_s(0, 50.0F, 10.0F) + 3.0F);
}

// At 290 m of 300, at rest, with a column beside whose last one is at 255 m at the horizon's end: building up its 5 m/s
// takes 7.8 m, and the front of ours must stay short of 300 m: its end cannot be joined. When that one has passed by,
// (296 + 1.5 + 13.5 - 255) / 5 = 11.2 s, we set off: 2 s for 4 m. 12 s at the limit for all: 3 + 13.2 - 12 s lost. From
// 278 m at 2 m/s it can be joined, and is followed: (300 + 15 - 255) / 5 = 12 s, 3 s lost.
TEST(LaneCostToGo, WhoCannotJoinWaitsForAllToPass) {
  Road road(180.0F);
  for (const float now_s_m : {270.0F, 255.0F, 240.0F}) road.vehicle(0, now_s_m, 5.0F);
  road.look();
  EXPECT_NEAR(road.cost_to_go.delay_s(1, 290.0F, 0.0F), 4.2F, 0.05F);
  EXPECT_NEAR(road.cost_to_go.delay_s(1, 278.0F, 2.0F), 3.0F, 0.05F);
}

// A change that we have to make comes first: with 60 m left for it time counts for nothing, with 90 m half of
// what it does with 120 m.
TEST(LaneCostToGo, DeadlinesComeBeforeTime) {
  float delays_s[3] = {};
  const float rooms_m[3] = {60.0F, 90.0F, 120.0F};
  for (int i = 0; i < 3; ++i) {
    Road road;
    need_changes(road.scene.ego_paths[0], 1, 20.0F + rooms_m[i]);
    road.scene.ego_paths[1].changes_needed = 0;
    road.vehicle(0, 60.0F, 5.0F);
    road.look();
    delays_s[i] = road.cost_to_go.delay_s(0, 50.0F, 10.0F);
  }
  EXPECT_EQ(delays_s[0], 0.0F);
  EXPECT_NEAR(delays_s[1], 0.5F * delays_s[2], 0.01F);
  EXPECT_NEAR(delays_s[2], 10.0F, 0.05F);
}

// Whom we could pass in time, but who leaves no room behind the one we cannot pass, is not passed either: 15
// m behind that one, at 57 m at the horizon's end, it costs (171.5 + 18.3 - 57) / 9 = 14.8 s: 2.8 s lost. At
// 25 m there is room: 5 + 5 m of lengths, 1 + 81/10 - 81/16 in front, 1 + 0.2 * 9 behind, 0.4 m to spare
// are 17.2 m.
TEST(LaneCostToGo, NoReturnIntoATightColumn) {
  float delays_s[2] = {};
  const float centres_m[2] = {30.0F, 20.0F};
  for (int i = 0; i < 2; ++i) {
    Road road;
    road.vehicle(0, 45.0F, 9.0F);
    road.vehicle(0, centres_m[i], 9.0F);
    road.look();
    delays_s[i] = road.cost_to_go.delay_s(1, 50.0F, 10.0F);
  }
  EXPECT_NEAR(delays_s[0], 2.76F, 0.05F);
  EXPECT_NEAR(delays_s[1], 1.1F, 0.05F);
}

// One abreast at our speed, the limit: we can only fall back behind it, 15.37 m behind its centre (see
// lane_gap_test.cpp) and 1 m more: 22 - 16.37 m. From 50 m at the horizon's end 13.37 m have to be lost: 5.48
// s.
TEST(LaneCostToGo, GapsAreAimedAt) {
  Road road;
  road.vehicle(1, 22.0F, 10.0F);  // at 52 m at the horizon's end
  road.look();
  EXPECT_NEAR(road.cost_to_go.time_to_gap_s(1, 50.0F, 10.0F), 5.48F, 0.05F);
  EXPECT_EQ(road.cost_to_go.time_to_gap_s(1, 36.0F, 10.0F), 0.0F);
  const trajectory::MergeTarget aim = road.cost_to_go.merge_target(road.scene, 1);
  EXPECT_EQ(aim.path, 1);
  EXPECT_NEAR(aim.s_m, 5.63F, 0.05F);
  EXPECT_EQ(aim.speed_mps, 10.0F);
}

// Behind a leader with its centre at 60 m and 5 m/s one stands with the rear axle at 60 - 5 - 2.5 - 1.5 = 51 m, and 10 m
// further 2 s later. There its speed is wanted, and nearer, too; 10 m before it sqrt(5^2 + 2 * 2.5 * 10) = 8.66 m/s; no
// jump from one to the other.
TEST(LaneCostToGo, WhoClosesUpIsAsFastAsTheLeaderWhereItHasItsPlace) {
  Road road;
  road.vehicle(0, 60.0F, 5.0F);
  road.look();
  const auto wanted_mps = [&](float s_m, float time_s) {
    return road.cost_to_go.closing_up_mps(0, 20.0F, s_m, time_s);
  };
  EXPECT_NEAR(wanted_mps(51.0F, 0.0F), 5.0F, 0.01F);
  EXPECT_NEAR(wanted_mps(61.0F, 2.0F), 5.0F, 0.01F);
  EXPECT_NEAR(wanted_mps(53.0F, 0.0F), 5.0F, 0.01F);
  EXPECT_NEAR(wanted_mps(41.0F, 0.0F), 8.66F, 0.01F);
  for (float s_m = 30.0F; s_m < 55.0F; s_m += 0.1F)
    EXPECT_LT(wanted_mps(s_m, 0.0F) - wanted_mps(s_m + 0.1F, 0.0F), 0.06F) << s_m;
}

// Behind one that stands with its centre at 60 m no speed is wanted from 51 m on. Who is behind us, or in the lane beside,
// asks for nothing.
TEST(LaneCostToGo, OnlyWhoIsAheadIsClosedUpOn) {
  Road road;
  road.vehicle(0, 60.0F, 0.0F);
  road.vehicle(0, 10.0F, 0.0F);
  road.look();
  EXPECT_EQ(road.cost_to_go.closing_up_mps(0, 20.0F, 51.5F, 1.0F), 0.0F);
  EXPECT_GT(road.cost_to_go.closing_up_mps(1, 20.0F, 51.5F, 1.0F), 50.0F);
  Road alone;
  alone.vehicle(0, 10.0F, 5.0F);
  alone.look();
  EXPECT_GT(alone.cost_to_go.closing_up_mps(0, 20.0F, 51.5F, 1.0F), 50.0F);
}

}  // namespace
}  // namespace s4tp::planner
