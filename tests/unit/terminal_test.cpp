// The terminal condition: when the end of a plan is safe for ever.

#include "algo/safety/terminal.hpp"

#include <gtest/gtest.h>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// We drive along +x towards a lane that crosses at x = 0 from south to north; the zone is 8 m long on both.
///   our path: s = x + 100; zone from s = 96 to 104, stop line (front bumper) at s = 95
///   their path: s = y + 100; zone from s = 96 to 104
struct Crossing {
  LaneMap map;
  LanePath ours;
  LanePath theirs;
  Scene scene;
  Parameters parameters;

  explicit Crossing(Priority priority) {
    const LaneIndex a = add_lane(map, {{-100.0F, 0.0F}, {300.0F, 0.0F}});
    const LaneIndex b = add_lane(map, {{0.0F, -100.0F}, {0.0F, 300.0F}});
    ours = path_of(map, {a});
    theirs = path_of(map, {b});
    EgoPath& way = add_way(scene, map, ours);
    ConflictZone zone;
    zone.entry_s_m = zone.other_entry_m = 96.0F;
    zone.exit_s_m = zone.other_exit_m = 104.0F;
    zone.stop_s_m = 95.0F;
    zone.other_lane = b;
    zone.priority = priority;
    (void)way.zones.push(zone);
  }

  /// Constant acceleration from rear axle position `s_m`.
  [[nodiscard]] bool safe(float s_m, float speed_mps, float acceleration_mps2) {
    TrajectoryPoint start = state_on(map, ours, s_m, speed_mps);
    put_ego(scene, start);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i)
      trajectory.points[i] = bicycle_step(trajectory.points[i - 1], acceleration_mps2, 0.0F, kStepS);
    return judge_terminal(scene, 0, trajectory, parameters).safe();
  }
  Agent& other(float s_m, float speed_mps) { return add_vehicle(scene, map, theirs, s_m, speed_mps); }
  [[nodiscard]] const ConflictZone& zone() const { return scene.ego_paths[0].zones[0]; }
};

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

// TERM-013 The same drive, the other 56 m away: there after 56 / 15.28 = 3.7 s, 0.8 s after we have left. Too
// little, but not for one who has stood 9 s; 47 m (3.1 s) is too little for him as well.
TEST(Terminal, WhoHasWaitedTakesASmallerGap) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 56.0F, 15.0F);
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.waited_s = 9.0F;
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 47.0F, 15.0F);
  near.scene.waited_s = 9.0F;
  EXPECT_FALSE(near.safe(80.0F, 8.0F, 0.0F));
}

// TERM-013 6.5 m before the zone at 8 m/s, stopping takes 4.9 m/s^2, and we leave after 1.9 s. The other, 38
// m away, comes after 2.5 s: not enough to begin with, but enough to go through with. 26 m (1.7 s) are not.
TEST(Terminal, ACrossingUnderWayIsFinished) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 38.0F, 15.0F);
  EXPECT_TRUE(crossing.safe(88.0F, 8.0F, 0.0F));
  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 26.0F, 15.0F);
  EXPECT_FALSE(near.safe(88.0F, 8.0F, 0.0F));
}

// TERM-014 From 91, at the line, at 2 m/s and braking with 1 m/s^2, we come to rest at 93: 1.5 m before the
// zone. Who has stood may wait there. Whoever comes along does not stop 6 m before the line only to roll over
// it.
TEST(Terminal, WhoHasStoodMayWaitBeyondTheLine) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(50.0F, 10.0F);
  EXPECT_FALSE(crossing.safe(91.0F, 2.0F, -1.0F));
  crossing.scene.waited_s = 0.5F;
  EXPECT_TRUE(crossing.safe(91.0F, 2.0F, -1.0F));
  EXPECT_FALSE(crossing.safe(85.0F, 3.0F, -0.5625F));
  EXPECT_FALSE(crossing.safe(91.0F, 2.0F, -0.6F));  // 3.3 m: into the zone
}

// TERM-015 From 93 with 3 m/s^2 we are in the zone after 1 s and out after 2.5 s. The other stands 9 m before
// it: starting now it is there after 3 s. That is enough once it has stood for 2 s with nobody to wait for;
// so with one who comes up behind it. Half a metre before the zone (0.7 s, and 0.5 s to start) it goes first,
// when we come from 91 (1.6 s).
TEST(Terminal, WhoStandsForNothingDoesNotUseHisRightOfWay) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 9.0F, 0.0F).idle_ms = 1900;
  EXPECT_FALSE(crossing.safe(93.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 2000;
  EXPECT_TRUE(crossing.safe(93.0F, 0.0F, 3.0F));
  (void)crossing.other(96.0F - 16.0F, 3.0F);
  EXPECT_TRUE(crossing.safe(93.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 0;
  EXPECT_FALSE(crossing.safe(93.0F, 0.0F, 3.0F));

  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 0.5F, 0.0F).idle_ms = 10'000;
  EXPECT_FALSE(near.safe(91.0F, 0.0F, 3.0F));
}

// TERM-015 From 93 with 3 m/s^2 we are out of the zone after 2.5 s. One who has stood for a second 7.5 m
// before it could be there after 2.7 s: without the usual margin, for he stands. 3.6 m before it (1.9 s) he
// goes first. So does who stood for less than a second.
TEST(Terminal, WhoStandsNeedsTimeToStart) {
  const auto crossing = [](float way_m, int samples_standing) {
    Crossing road(Priority::kFirstYields);
    Agent& other = road.other(96.0F - way_m, 0.0F);
    other.history.valid = (1U << kHistorySamples) - 1U;
    for (int i = 0; i < kHistorySamples - samples_standing; ++i) other.history.samples[i].speed_mps = 1.0F;
    return road.safe(93.0F, 0.0F, 3.0F);
  };
  EXPECT_TRUE(crossing(7.5F, kHistorySamples));
  EXPECT_FALSE(crossing(7.5F, kHistorySamples - 1));
  EXPECT_FALSE(crossing(3.6F, kHistorySamples));
}

// TERM-015 Four where the right goes before the left: the one on our right stands 3.3 m before the zone, and
// could be there after 1.8 s, we after 1.6 s. He waits for his right, who waits for nobody that moves: one
// has to begin.
TEST(Terminal, AStandOffIsEnded) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 3.3F, 0.0F);
  EXPECT_FALSE(crossing.safe(91.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 2500;
  EXPECT_TRUE(crossing.safe(91.0F, 0.0F, 3.0F));
}

// TERM-016 At 3 m/s inside one zone, 4.5 m before the next (there after 1.5 s, out after 3.5 s). The other is
// 9 m before that, at 2 m/s there after sqrt(10) - 1 = 2.2 s at the earliest: we do not stop in the first
// zone for it. Outside of any zone we would; and for one who comes at 13 m/s, too.
TEST(Terminal, NobodyStopsInOneZoneForTheNext) {
  const auto crossing = [](bool inside_one, float way_m, float speed_mps) {
    Crossing road(Priority::kFirstYields);
    ConflictZone next = road.zone();
    next.entry_s_m = 106.0F;
    next.exit_s_m = 112.0F;
    next.stop_s_m = 95.0F;
    if (!inside_one) road.scene.ego_paths[0].zones.clear();
    (void)road.scene.ego_paths[0].zones.push(next);
    road.other(96.0F - way_m, speed_mps);
    return road.safe(100.0F, 3.0F, 0.0F);
  };
  EXPECT_TRUE(crossing(true, 9.0F, 2.0F));
  EXPECT_FALSE(crossing(false, 9.0F, 2.0F));
  EXPECT_FALSE(crossing(true, 40.0F, 13.0F));
}

// TERM-004 Who owes us the way and needs less than 4 m/s^2 (10 m/s: 12.5 m) is trusted; who needs more is
// not.
TEST(Terminal, OthersAreTrustedWhileTheyCanStop) {
  Crossing can(Priority::kFirstHasPriority);
  can.other(96.0F - 13.5F, 10.0F);
  EXPECT_TRUE(can.safe(78.0F, 10.0F, 0.0F));
  Crossing cannot(Priority::kFirstHasPriority);
  cannot.other(96.0F - 11.5F, 10.0F);
  EXPECT_FALSE(cannot.safe(78.0F, 10.0F, 0.0F));
}

// TERM-004 First come: at equal speeds and the other twice as far we go; the other way round we do not.
TEST(Terminal, FirstComeFirstServed) {
  Crossing first(Priority::kFirstCome);
  first.other(96.0F - 60.0F, 8.0F);
  EXPECT_TRUE(first.safe(80.0F, 8.0F, 0.0F));
  Crossing second(Priority::kFirstCome);
  second.other(96.0F - 8.0F, 8.0F);
  EXPECT_FALSE(second.safe(80.0F, 8.0F, 0.0F));
}

// TERM-005 The other leaves the zone in 4 m at 10 m/s; we come in 1.8 s: nothing to wait for.
TEST(Terminal, WhoIsGoneBeforeWeComeDoesNotCount) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(100.0F, 10.0F);
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.agents[0].track.speed_mps = 0.5F;  // it crawls: in 4 m it is not gone
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
}

// TERM-006 Braking so as to come to rest at s = 80 + 64 / 6 = 90.7 is before the zone; 97 would be in it.
TEST(Terminal, NobodyStopsInAZone) {
  Crossing crossing(Priority::kFirstYields);
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, -3.0F));
  EXPECT_FALSE(crossing.safe(86.5F, 8.0F, -3.0F));
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

// TERM-012 The road ends at 400 m and one lane change is due: 25 m stay for it. From s = 330 at 10 m/s the
// front comes to rest at 330 + 30 + 4 + 100 / 5.5 = 382 m: too far; without a change due it is not.
TEST(Terminal, RoomIsLeftForTheLaneChange) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  EXPECT_TRUE(crossing.safe(330.0F, 10.0F, 0.0F));
  crossing.map.lanes[0].changes_needed = 1;
  EXPECT_FALSE(crossing.safe(330.0F, 10.0F, 0.0F));
  EXPECT_TRUE(crossing.safe(318.0F, 10.0F, 0.0F));
}

// TERM-012 Who has passed the last place for it keeps what room is left: no driving on in that lane, but a
// stop at once. From s = 372, the front at 376 m of the 375 allowed, at 5 m/s: 3 s of braking at 2 m/s^2
// stop.
TEST(Terminal, RoomForTheLaneChangeIsNotEatenUp) {
  Crossing crossing(Priority::kFirstYields);
  crossing.map.lanes[0].on_route = false;
  crossing.map.lanes[0].changes_needed = 1;
  EXPECT_FALSE(crossing.safe(372.0F, 5.0F, 0.0F));
  EXPECT_FALSE(crossing.safe(372.0F, 0.0F, 1.0F));
  EXPECT_TRUE(crossing.safe(372.0F, 5.0F, -2.6F));
  EXPECT_TRUE(crossing.safe(372.0F, 0.0F, 0.0F));
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

// TERM-003 Who comes after us into the same lane may meet us on the way in: he must not be at the zone's exit
// 1 s after we have left it. From s = 80 at 8 m/s we leave after 2.8 s; he, at 13 m/s gaining 2 m/s^2 up
// to 15.28, needs 3.6 s for the 54 m to the entry and 4.1 s for the 62 m to the exit: enough when he merges,
// too near when he crosses.
TEST(Terminal, AMergeIsLeftBehind) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 54.0F, 13.0F);
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.ego_paths[0].zones[0].merging = true;
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
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

// TERM-010 Changing at 10 m/s in front of one at 10 m/s: 15 m of gap (2.5 + 0.6 * 10 needed) are enough, 6 m
// not.
TEST(Terminal, LaneChangeLeavesTheFollowerRoom) {
  for (const float gap_m : {7.0F, 5.0F}) {
    LaneMap map = straight_road(2, 400.0F);
    Scene scene;
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 100.0F, 10.0F);
    put_ego(scene, start);
    add_vehicle(scene, map, scene.ego_paths[1].path, 99.0F - gap_m - 2.5F, 10.0F);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      trajectory.points[i] = bicycle_step(trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
      trajectory.points[i].rear_axle.y_m = kLaneWidthM * static_cast<float>(i) / 30.0F;
    }
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), gap_m > 6.0F) << gap_m;
    scene.agents.clear();
    add_vehicle(scene, map, scene.ego_paths[1].path, 104.0F + gap_m - 1.0F + 2.5F, 10.0F);
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), gap_m > 6.0F) << gap_m;
  }
}

// TERM-010 The lane we come to begins where we are, and the follower is still on the lane before it: he
// follows all the same.
TEST(Terminal, FollowersBeforeTheLanesStartCount) {
  for (const float gap_m : {7.0F, 5.0F}) {
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
    EXPECT_EQ(judge_terminal(scene, 1, trajectory, Parameters{}).safe(), gap_m > 6.0F) << gap_m;
  }
}

// TERM-011 10 m before the entry at the top speed of 1.1 * 13.89 = 15.28 m/s: 0.654 s. From rest with 2
// m/s^2: sqrt(2 * 10 / 2) = 3.16 s. Inside 0; past it or elsewhere 1000.
TEST(EarliestArrival, FreeToAccelerate) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(86.0F, 15.279F);
  crossing.other(86.0F, 0.0F);
  crossing.other(100.0F, 5.0F);
  crossing.other(105.0F, 5.0F);
  add_vehicle(crossing.scene, crossing.map, crossing.ours, 50.0F, 10.0F);
  const float expected[] = {0.654F, 3.162F, 0.0F, 1000.0F, 1000.0F};
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(earliest_arrival_s(crossing.scene, i, crossing.zone(), crossing.parameters), expected[i],
                0.01F)
        << i;
}

// TERM-011 Who brakes with 4 m/s^2 goes on for half a second: from 10 m/s to 8 in 4.5 m, and then 15.5 m from
// there in (sqrt(64 + 62) - 8) / 2 = 1.61 s.
TEST(EarliestArrival, BrakesAreNotDriveAtOnce) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 20.0F, 10.0F).track.acceleration_mps2 = -4.0F;
  EXPECT_NEAR(earliest_arrival_s(crossing.scene, 0, crossing.zone(), crossing.parameters), 2.11F, 0.01F);
}

// TERM-002 Without a map or path nothing can be promised.
TEST(Terminal, NoPathIsNotSafe) {
  EXPECT_FALSE(judge_terminal(Scene{}, 0, Trajectory{}, Parameters{}).safe());
}

}  // namespace
}  // namespace s4tp
