// What the guard reckons with beyond the ground on which everybody is known.
//
// We stand at 95.3 of our way, 0.7 m before a zone that is ours from 96 to 104, and leave with 2 m/s^2: the exit
// is 2.95 s away. Whoever comes unseen does 13.89 m/s, gains 2 m/s^2 up to 15.28, and is first seen `r` from us:
// sqrt(r^2 - 4.7^2) before the middle of the zone, that less 4 m before its entry.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/lane_change_road.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Nobody is missing within `radius_m` of our box centre at `centre_s_m`.
scene::KnownGround known_within(float radius_m, float centre_s_m = 95.3F) {
  return {{centre_s_m - 100.0F, 0.0F}, radius_m, 0, 1};
}

// GUARD-012 40 m around us are known: from there it is 35.7 m to the zone, 2.37 s, and nobody who comes so fast
// stops gently. At 60 m it is 55.8 m and 3.68 s: we are gone. While nobody is left out nobody is expected.
TEST(GuardUnseen, SomebodyMayComeFromTheEdge) {
  for (const float radius_m : {40.0F, 60.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(radius_m);
    const Verdict verdict = road.judge(95.3F, 0.0F, 2.0F);
    EXPECT_EQ(verdict.safe(), radius_m > 50.0F) << radius_m;
    if (verdict.safe()) continue;
    EXPECT_EQ(verdict.cause, Cause::kZone);
    EXPECT_EQ(verdict.agent, kUnseen);
    EXPECT_NEAR(verdict.from_s, 2.37F, 0.03F);
    EXPECT_NEAR(verdict.needed_s, 2.95F, 0.06F);
    road.scene.known = scene::KnownGround{};
    EXPECT_TRUE(road.safe(95.3F, 0.0F, 2.0F));
  }
}

// GUARD-012 50 m around us are known, 45.8 m before the zone: 3.03 s. A list 300 ms old says so of then.
TEST(GuardUnseen, WhoIsUnseenComesNearerWhileListsAreMissing) {
  for (const std::uint16_t age_ms : {std::uint16_t{0}, std::uint16_t{300}}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(50.0F);
    road.scene.known.age_ms = age_ms;
    EXPECT_EQ(road.safe(95.3F, 0.0F, 2.0F), age_ms == 0) << age_ms;
  }
}

// GUARD-012 D1: whoever owes us the way stops from 13.89 m/s within 38.0 m, 1 s of response included.
TEST(GuardUnseen, WhoIsUnseenOwesUsTheWayLikeOthers) {
  for (const float to_entry_m : {37.0F, 39.0F}) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.known = known_within(std::hypot(to_entry_m + 4.0F, 4.7F));
    EXPECT_EQ(road.safe(95.3F, 0.0F, 2.0F), to_entry_m > 38.0F) << to_entry_m;
  }
}

// GUARD-012 One that stands 6 m before the zone and leaves it to us is in the way of whoever may come behind it;
// one on another lane is in nobody's.
TEST(GuardUnseen, WhoStaysOutHoldsBackWhoeverComesBehind) {
  for (const bool same_lane : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(40.0F);
    if (!same_lane) road.theirs = path_of(road.map, {add_lane(road.map, {{9.0F, -100.0F}, {9.0F, -5.0F}})});
    scene::Agent& ahead = road.other(90.0F, 0.0F);
    ahead.stood_ms = 1000;
    road.scene.waited_s = 1.0F;
    EXPECT_EQ(road.safe(95.3F, 0.0F, 2.0F), same_lane);
  }
}

// GUARD-012 One that is leaving the zone at 10 m/s holds nobody back.
TEST(GuardUnseen, SomebodyMayComeBehindWhoHasPassed) {
  SharedGround road(Priority::kFirstYields);
  road.other(102.0F, 10.0F);
  EXPECT_TRUE(road.safe(95.3F, 0.0F, 2.0F));
  road.scene.known = known_within(40.0F);
  EXPECT_EQ(road.judge(95.3F, 0.0F, 2.0F).agent, kUnseen);
}

// GUARD-012 From 84 at 12 m/s we leave the zone after 1.7 s. One seen 22 m before it at 4 m/s is there after 2.9 s
// at the earliest, and nobody behind it sooner, though from the edge, 24 m before it, it were 1.66 s.
TEST(GuardUnseen, NobodyOvertakesWhoIsAheadInItsLane) {
  for (const bool anybody : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    if (anybody) road.other(74.0F, 4.0F);
    road.scene.known = known_within(std::hypot(28.0F, 16.0F), 84.0F);
    EXPECT_EQ(road.safe(84.0F, 12.0F, 0.0F), anybody);
  }
}

// GUARD-012 Beyond the zone, at 150. From 12 m/s the fail-safe stands 17.1 m on, its front 2.5 m further, 0.5 m
// clear of a rear 2.5 m before the edge: 22.6 m must be known.
TEST(GuardUnseen, SomebodyMayStandWhereKnownGroundEnds) {
  for (const float radius_m : {22.1F, 23.1F}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(radius_m, 150.0F);
    const Verdict verdict = road.judge(150.0F, 12.0F, 0.0F);
    EXPECT_EQ(verdict.safe(), radius_m > 22.6F) << radius_m;
    if (!verdict.safe()) {
      EXPECT_EQ(verdict.cause, Cause::kLeader);
      EXPECT_EQ(verdict.agent, kUnseen);
    }
  }
}

// GUARD-012 One that leads us at our own speed, 15 m ahead, is in the way of whoever may stand further on.
TEST(GuardUnseen, WhoLeadsUsIsNearerThanWhoeverMayStandAhead) {
  SharedGround road(Priority::kFirstYields);
  road.scene.known = known_within(21.2F, 150.0F);
  road.leader(165.0F, 12.0F);
  EXPECT_TRUE(road.safe(150.0F, 12.0F, 0.0F));
}

/// We are in the right one of two lanes, at 100 m, at 10 m/s, and change to the left one.
struct Change : LaneChangeRoad {
  [[nodiscard]] Verdict judge(int path) {
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 98.5F, 10.0F);
    put_ego(scene, start);
    Guard guard;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(path, across(start, 0.0F, path != 0 ? kLaneWidthM : 0.0F));
  }
};

// GUARD-012 Behind us somebody may come at 13.89 m/s in the lane we change into: too near from 9 m, not from 60.
// In our own lane it is its own business. One that follows us there at our speed is nearer.
TEST(GuardUnseen, SomebodyMayComeInTheLaneWeChangeInto) {
  for (const float radius_m : {9.0F, 60.0F}) {
    Change change;
    change.scene.known = {{100.0F, 0.0F}, radius_m, 0, 1};
    add_vehicle(change.scene, change.map, path_of(change.map, {0}), 120.0F, 12.0F);  // nobody stands there
    add_vehicle(change.scene, change.map, path_of(change.map, {1}), 130.0F, 12.0F);
    const Verdict verdict = change.judge(1);
    EXPECT_EQ(verdict.cause, radius_m < 30.0F ? Cause::kFollower : Cause::kNone) << radius_m;
    EXPECT_EQ(verdict.agent, radius_m < 30.0F ? kUnseen : 255);
    EXPECT_TRUE(change.judge(0).safe());
    add_vehicle(change.scene, change.map, path_of(change.map, {1}), 91.5F, 9.0F);
    EXPECT_TRUE(change.judge(1).safe()) << radius_m;
  }
}

// GUARD-012 All of the other road that we are told of is known, from 100 m before its zone. Where lanes were left
// out, somebody may come by one of those: 120 m around us are known, so 19.9 m further off. At 30 m/s, 33 in the
// end, that takes 3.6 s; with 1 m/s^2 we are out after 4.2 s.
TEST(GuardUnseen, SomebodyMayComeByALaneThatWasLeftOut) {
  for (const std::uint8_t left_out : {std::uint8_t{0}, std::uint8_t{1}}) {
    SharedGround road(Priority::kFirstYields);
    road.map.lanes[road.zone().other_lane].speed_limit_mps = 30.0F;
    road.map.lanes_left_out = left_out;
    road.scene.known = known_within(120.0F);
    const Verdict verdict = road.judge(95.3F, 0.0F, 1.0F);
    EXPECT_EQ(verdict.agent, left_out > 0 ? kUnseen : 255);
    EXPECT_NEAR(verdict.from_s, left_out > 0 ? 3.6F : 0.0F, 0.1F);
  }
}

// GUARD-012 The road they come on is cut into two lanes just where the known ground begins, with 2 cm between
// them: whoever comes is there all the same.
TEST(GuardUnseen, AnEdgeBetweenTwoLanesIsSeen) {
  SharedGround road(Priority::kFirstYields);
  const LaneIndex other = road.zone().other_lane;
  const float edge_m = std::sqrt(40.0F * 40.0F - 4.7F * 4.7F);
  Lane& lane = road.map.lanes[other];
  lane.points[0] = {0.0F, -edge_m + 0.01F};
  lane.length_m = 300.0F + edge_m - 0.01F;
  const LaneIndex before = add_lane(road.map, {{0.0F, -100.0F}, {0.0F, -edge_m - 0.01F}});
  link(road.map, before, other);
  scene::ConflictZone& zone = road.zone();
  zone.other_entry_m = edge_m - 4.0F - 0.01F;
  zone.other_exit_m = zone.other_entry_m + 8.0F;
  road.scene.known = known_within(40.0F);
  EXPECT_EQ(road.judge(95.3F, 0.0F, 2.0F).agent, kUnseen);
}

/// Fills a map with lanes that wind in and out of the ground known within 60 m of (x_m, 0), far from all others.
void add_winding_lanes(LaneMap& map, float x_m) {
  std::vector<Point> points;
  for (int i = 0; i < kMaxLanePoints; ++i)
    points.push_back({x_m + static_cast<float>(i - 6), i % 2 == 0 ? 70.0F : 50.0F});
  while (add_lane(map, points) + 1 < kMaxLanes) {
  }
}

// GUARD-012 60 m around us are known: we are gone before anybody is there, and nobody behind us comes too near. Where
// the map has lanes that lead in three hundred times over, none of which is near us, they are more than can be
// followed: the zone counts as taken and the lane beside as occupied. Our own lane stays ours.
TEST(GuardUnseen, LanesThatCannotAllBeFollowed) {
  for (const bool winding : {false, true}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(60.0F);
    if (winding) add_winding_lanes(road.map, -4.7F);
    EXPECT_EQ(road.judge(95.3F, 0.0F, 2.0F).cause, winding ? Cause::kZone : Cause::kNone);
    Change change;
    change.scene.known = {{100.0F, 0.0F}, 60.0F, 0, 1};
    add_vehicle(change.scene, change.map, path_of(change.map, {0}), 120.0F, 12.0F);  // nobody stands there
    add_vehicle(change.scene, change.map, path_of(change.map, {1}), 130.0F, 12.0F);
    if (winding) add_winding_lanes(change.map, 100.0F);
    EXPECT_EQ(change.judge(1).cause, winding ? Cause::kFollower : Cause::kNone);
    EXPECT_TRUE(change.judge(0).safe());
  }
}

}  // namespace
}  // namespace s4tp::safety
