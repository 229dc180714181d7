// The terminal condition: when the end of a plan is safe for ever.

#include "algo/safety/terminal.hpp"

#include <gtest/gtest.h>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "tests/support/crossing.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

// TERM-001 Whoever comes: at 10 m/s after 3 s at s = 70 the front is 21 m before the line; v^2 / 2b = 20 m
// fit. From 5 m further on they do not.
TEST(Terminal, CanStillStopBeforeTheZone) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(30.0F, 10.0F);
  EXPECT_TRUE(crossing.safe(40.0F, 10.0F, 0.0F));
  EXPECT_FALSE(crossing.safe(45.0F, 10.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(90.0F, 0.0F, 0.0F));  // standing with the front one metre before the line
}

// TERM-002 With nobody about, any passage is safe.
TEST(Terminal, EmptyRoadIsFree) {
  Crossing crossing(Priority::kFirstYields);
  for (const float s_m : {40.0F, 60.0F, 80.0F, 90.0F}) EXPECT_TRUE(crossing.safe(s_m, 10.0F, 1.0F)) << s_m;
}

// TERM-003 From s = 80 at 8 m/s the rear axle leaves (s = 102.5) after 2.8 s. Who yields leaves 1 s: the
// other, at its limit of 15.28 m/s in no time, needs 3.8 s * 15.28 = 58 m to the entry: at 45 m it is too
// near, at 70 m not.
TEST(Terminal, GapMustLastUntilWeAreGone) {
  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 45.0F, 13.0F);
  EXPECT_FALSE(near.safe(80.0F, 8.0F, 0.0F));
  Crossing far(Priority::kFirstYields);
  far.other(96.0F - 70.0F, 13.0F);
  EXPECT_TRUE(far.safe(80.0F, 8.0F, 0.0F));
}

// TERM-014 From 91, at the line, at 2 m/s and braking with 1 m/s^2, we come to rest at 93: 1.5 m before the
// zone. Who has waited for 20 s may go on waiting there: before, others would only brake for our nose.
// Whoever comes along does not stop 6 m before the line only to roll over it.
TEST(Terminal, WhoHasWaitedLongMayWaitBeyondTheLine) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(50.0F, 10.0F);
  EXPECT_FALSE(crossing.safe(91.0F, 2.0F, -1.0F));
  crossing.scene.waited_s = 19.5F;
  EXPECT_FALSE(crossing.safe(91.0F, 2.0F, -1.0F));
  crossing.scene.waited_s = 20.5F;
  EXPECT_TRUE(crossing.safe(91.0F, 2.0F, -1.0F));
  EXPECT_FALSE(crossing.safe(85.0F, 3.0F, -0.5625F));
  EXPECT_FALSE(crossing.safe(91.0F, 2.0F, -0.6F));  // 3.3 m: into the zone
}

// TERM-006 Braking so as to come to rest at s = 80 + 64 / 6 = 90.7 is before the zone; 97 would be in it.
TEST(Terminal, NobodyStopsInAZone) {
  Crossing crossing(Priority::kFirstYields);
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, -3.0F));
  EXPECT_FALSE(crossing.safe(86.5F, 8.0F, -3.0F));
}

// TERM-023 One who has stood for 20 s with his front 0.7 m from our centre line would let us go first, but
// stands 0.2 m inside our way. With his front at 1.3 m he leaves 0.4 m.
TEST(Terminal, WhoLetsUsGoMustLeaveRoom) {
  for (const float front_m : {-0.7F, -1.3F}) {
    Crossing crossing(Priority::kFirstYields);
    crossing.other(100.0F + front_m - 2.5F, 0.0F).idle_ms = 20'000;
    EXPECT_EQ(crossing.safe(91.0F, 0.0F, 3.0F), front_m < -1.0F) << front_m;
  }
}

// TERM-023 With his front 1.2 m from our centre line he leaves 0.3 m, and 0.65 m to us 0.35 m further on.
TEST(Terminal, RoomIsLeftToWhereWeDrive) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(100.0F - 1.2F - 2.5F, 0.0F).idle_ms = 20'000;
  EXPECT_FALSE(crossing.safe(91.0F, 0.0F, 3.0F));
  crossing.scene.ego_paths[0].aside_m = 0.35F;
  EXPECT_TRUE(crossing.safe(91.0F, 0.0F, 3.0F));
}

// TERM-007 Already inside, standing and driving on both are for the collision check to judge.
TEST(Terminal, WhoIsInsideIsLeftToTheCollisionCheck) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(80.0F, 10.0F);
  EXPECT_TRUE(crossing.safe(97.0F, 0.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(97.0F, 0.0F, 1.5F));
}

// TERM-001 Waiting between stop line (rear axle at 91) and zone (94.5): standing at 92 is fine; standing
// nearer than 0.7 m is too, but nobody creeps on from there.
TEST(Terminal, NobodyCreepsTowardsTheZone) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(80.0F, 10.0F);
  EXPECT_TRUE(crossing.safe(92.0F, 0.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(94.0F, 0.0F, 0.0F));
  EXPECT_FALSE(crossing.safe(94.0F, 0.1F, 0.0F));
}

// TERM-012 The road ends at 400 m and one lane change is due: 15 m stay for it. From s = 336 at 10 m/s the
// front comes to rest at 336 + 30 + 4 + 100 / 5.5 = 388 m: too far; without a change due it is not.
TEST(Terminal, RoomIsLeftForTheLaneChange) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  EXPECT_TRUE(crossing.safe(336.0F, 10.0F, 0.0F));
  crossing.map.lanes[0].changes_needed = 1;
  EXPECT_FALSE(crossing.safe(336.0F, 10.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(330.0F, 10.0F, 0.0F));
}

// TERM-012 Who has passed the last place for it keeps what room is left: no driving on in that lane, but a
// stop at once. From s = 382, the front at 386 m of the 385 allowed, at 5 m/s: 3 s of braking at 2 m/s^2
// stop.
TEST(Terminal, RoomForTheLaneChangeIsNotEatenUp) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  crossing.map.lanes[0].changes_needed = 1;
  EXPECT_FALSE(crossing.safe(382.0F, 5.0F, 0.0F));
  EXPECT_FALSE(crossing.safe(382.0F, 0.0F, 1.0F));
  EXPECT_TRUE(crossing.safe(382.0F, 5.0F, -2.6F));
  EXPECT_TRUE(crossing.safe(382.0F, 0.0F, 0.0F));
}

// TERM-008 A road that ends 400 m on: from s = 340 at 10 m/s the end of the plan can stop; from 360 it
// cannot, unless the goal comes first.
TEST(Terminal, RoadEndsCount) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  EXPECT_TRUE(crossing.safe(340.0F, 10.0F, 0.0F));
  EXPECT_FALSE(crossing.safe(360.0F, 10.0F, 0.0F));
  crossing.map.lanes[0].on_route = true;
  EXPECT_TRUE(crossing.safe(360.0F, 10.0F, 0.0F));
}

// TERM-008 With the front at 400.5 m already, over the end of that road, going on is no plan; standing is.
TEST(Terminal, NobodyLeavesTheRoadForBeingAtItsEnd) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  const float s_m = 400.5F - rear_axle_to_front_m(crossing.parameters);
  EXPECT_FALSE(crossing.safe(s_m, 0.5F, 2.0F));
  EXPECT_TRUE(crossing.safe(s_m, 0.0F, 0.0F));
}

// TERM-009 Behind a leader at 10 m/s we drive 10.1: it needs 100 / 16 = 6.25 m to stop, we 102 / 12 = 8.5 m.
// Of a gap of 3 m, 0.3 m are used up in 3 s and 0.45 m are left when both stand (0.3 needed); of 1 m nothing.
// Behind one that brakes with 4 m/s^2, keeping on is not safe from 10 m, braking likewise is.
TEST(Terminal, StopsBehindTheLeader) {
  for (const float gap_m : {3.0F, 1.0F}) {
    Crossing crossing(Priority::kFirstYields);
    crossing.scene.ego_paths[0].zones.clear();
    add_vehicle(crossing.scene, crossing.map, crossing.ours, 10.0F + 4.0F + gap_m + 2.5F, 10.0F);
    EXPECT_EQ(crossing.safe(10.0F, 10.1F, 0.0F), gap_m > 2.5F) << gap_m;
  }
  Crossing crossing(Priority::kFirstYields);
  crossing.scene.ego_paths[0].zones.clear();
  Agent& leader = add_vehicle(crossing.scene, crossing.map, crossing.ours, 26.5F, 10.0F);
  leader.track.acceleration_mps2 = -4.0F;
  EXPECT_FALSE(crossing.safe(10.0F, 10.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(10.0F, 10.0F, -4.0F));
}

// TERM-010 Changing at 10 m/s among others as fast: 1 + 0.2 * 10 = 3 m are needed to the one behind, 1 + 100
// / 10 - 100 / 16 = 4.75 m to the one ahead. One behind at 13 m/s comes 9 m nearer within the horizon, and
// 3 * 0.5 + 9 / 6 m until he is as slow: 1 + 3 m are needed then, 13 m now.
TEST(Terminal, LaneChangeKeepsItsDistances) {
  for (const float spare_m : {0.3F, -0.3F}) {
    LaneMap map = straight_road(2, 400.0F);
    Scene scene;
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 100.0F, 10.0F);
    put_ego(scene, start);
    add_vehicle(scene, map, scene.ego_paths[1].path, 99.0F - (3.0F + spare_m) - 2.5F, 10.0F);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
      trajectory.points[i].rear_axle.y_m = kLaneWidthM * static_cast<float>(i) / 30.0F;
    }
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), spare_m > 0.0F) << spare_m;
    scene.agents.clear();
    add_vehicle(scene, map, scene.ego_paths[1].path, 104.0F + (4.75F + spare_m) + 2.5F, 10.0F);
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), spare_m > 0.0F) << spare_m;
    scene.agents.clear();
    add_vehicle(scene, map, scene.ego_paths[1].path, 99.0F - (13.0F + spare_m) - 2.5F, 13.0F);
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), spare_m > 0.0F) << spare_m;
  }
}

// TERM-031 The plan starts 0.2 s and 2 m on. 5.25 m are enough ahead of one as fast (4.75 m needed); it has
// driven 2 m meanwhile, too. TERM-009 One who brakes with 0.4 m/s^2 keeps his speed, one with 0.6 has 5.25 -
// 2.7 m left after 3 s.
TEST(Terminal, LeadersDriveUntilOurPlanStarts) {
  for (const float braking_mps2 : {0.0F, 0.4F, 0.6F}) {
    LaneMap map = straight_road(2, 400.0F);
    Scene scene;
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    put_ego(scene, state_on(map, scene.ego_paths[0].path, 98.0F, 10.0F));
    Agent& leader = add_vehicle(scene, map, scene.ego_paths[1].path, 98.0F + 4.0F + 5.25F + 2.5F, 10.0F);
    leader.track.acceleration_mps2 = -braking_mps2;
    Trajectory trajectory;
    trajectory.points[0] = state_on(map, scene.ego_paths[0].path, 100.0F, 10.0F);
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
      trajectory.points[i].rear_axle.y_m = kLaneWidthM * static_cast<float>(i) / 30.0F;
    }
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), braking_mps2 < 0.5F) << braking_mps2;
  }
}

// TERM-010 The lane we come to begins where we are, and the follower is still on the lane before it: he
// follows all the same.
TEST(Terminal, FollowersBeforeTheLanesStartCount) {
  for (const float gap_m : {3.3F, 2.7F}) {
    LaneMap map = straight_road(2, 400.0F);
    const LaneIndex before = add_lane(map, {{-200.0F, kLaneWidthM}, {0.0F, kLaneWidthM}});
    link(map, before, 1);
    Scene scene;
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 2.0F, 10.0F);
    put_ego(scene, start);
    add_vehicle(scene, map, path_of(map, {before, 1}), 200.0F + 1.0F - gap_m - 2.5F, 10.0F);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
      trajectory.points[i].rear_axle.y_m = kLaneWidthM * static_cast<float>(i) / 30.0F;
    }
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), gap_m > 3.0F) << gap_m;
  }
}

// TERM-002 Without a map or path nothing can be promised.
TEST(Terminal, NoPathIsNotSafe) {
  EXPECT_FALSE(judge_terminal(Scene{}, 0, Trajectory{}, Parameters{}).safe());
}

}  // namespace
}  // namespace s4tp
