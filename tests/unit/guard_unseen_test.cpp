// What the guard reckons with beyond the ground on which everybody is known.
//
// We stand at 95.3 of our way, 0.7 m before a zone that is ours from 96 to 104, and leave with 2 m/s^2: the exit
// is 2.95 s away. Where all who stand are known within `r` of us, their lane comes in sqrt(r^2 - 4.7^2) before the middle
// of the zone, that less 4 m before its entry. Who drives 15.28 m/s, a tenth more than the limit, is listed until 30.56 m
// further off; reckoned with is one at 30.56 - 4 = 26.56 m, as one that is slower yet may be as near in the end. Who
// stands at the edge can stop gently from 5 m before the zone on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/lane_change_road.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Nobody is missing within `radius_m` of our box centre at `centre_s_m`.
scene::KnownGround known_within(float radius_m, float centre_s_m = 95.3F) {
  return {{centre_s_m - 100.0F, 0.0F}, radius_m, 0, 1, {}};
}

// GUARD-012 22 m around us are known: from there it is 17.5 m to the zone, 26.56 more are 2.88 s, and nobody who comes so
// fast stops gently. At 30 m it is 25.6 m and 3.42 s: we are gone. While nobody is left out nobody is expected.
TEST(GuardUnseen, SomebodyMayComeFromTheEdge) {
  for (const float radius_m : {22.0F, 30.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(radius_m);
    const Verdict verdict = road.judge(95.3F, 0.0F, 2.0F);
    EXPECT_EQ(verdict.safe(), radius_m > 25.0F) << radius_m;
    if (verdict.safe()) continue;
    EXPECT_EQ(verdict.cause, Cause::kZone);
    EXPECT_EQ(verdict.agent, kUnseen);
    EXPECT_NEAR(verdict.from_s, 2.88F, 0.03F);
    EXPECT_NEAR(verdict.needed_s, 2.95F, 0.06F);
    road.scene.known = scene::KnownGround{};
    EXPECT_TRUE(road.safe(95.3F, 0.0F, 2.0F));
  }
}

// GUARD-012 Whoever was left out x beyond the edge, at x / 2 m/s at most, and drives as fast as may be from then on, is in the
// zone no sooner than was reckoned with.
TEST(GuardUnseen, NobodyLeftOutComesSooner) {
  SharedGround road(Priority::kFirstYields);
  const float to_entry_m = 12.0F;
  road.scene.known = known_within(std::hypot(to_entry_m + 4.0F, 4.7F));
  const float from_s = road.judge(95.3F, 0.0F, 2.0F).from_s;
  ASSERT_GT(from_s, 2.0F);
  int fast = 0;
  for (float beyond_m = 0.0F; beyond_m < 80.0F; beyond_m += 0.5F) {
    const float speed_mps = std::min(beyond_m / kListLeadS, 15.28F);
    const occupancy::Pace fastest{speed_mps, 2.0F, 15.28F};
    const bool stops_gently = to_entry_m + beyond_m - 0.5F - occupancy::way_after_m(fastest, 1.5F) >
                              std::pow(occupancy::speed_after_mps(fastest, 1.5F), 2.0F) / 4.0F;
    if (stops_gently) continue;
    ++fast;
    EXPECT_GT(occupancy::time_to_cover_s(fastest, to_entry_m + beyond_m), from_s - 0.01F) << beyond_m;
  }
  EXPECT_GT(fast, 50);
}

// GUARD-012 26 m around us are known, 21.6 m before the zone: 3.15 s. A list 300 ms old says so of then.
TEST(GuardUnseen, WhoIsUnseenComesNearerWhileListsAreMissing) {
  for (const std::uint16_t age_ms : {std::uint16_t{0}, std::uint16_t{300}}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(26.0F);
    road.scene.known.age_ms = age_ms;
    EXPECT_EQ(road.safe(95.3F, 0.0F, 2.0F), age_ms == 0) << age_ms;
  }
}

// GUARD-012 D1: whoever owes us the way stops from 15.28 m/s within 44.5 m, 1 s of response included: 17.9 m from the edge on.
// We leave with 1.5 m/s^2, after 3.4 s: nobody is that late.
TEST(GuardUnseen, WhoIsUnseenOwesUsTheWayLikeOthers) {
  for (const float to_entry_m : {17.0F, 19.0F}) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.known = known_within(std::hypot(to_entry_m + 4.0F, 4.7F));
    EXPECT_EQ(road.safe(95.3F, 0.0F, 1.5F), to_entry_m > 17.9F) << to_entry_m;
  }
}

// GUARD-012 One that stands 6 m before the zone and leaves it to us is in the way of whoever may come behind it;
// one on another lane is in nobody's.
TEST(GuardUnseen, WhoStaysOutHoldsBackWhoeverComesBehind) {
  for (const bool same_lane : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.known = known_within(22.0F);
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
  road.scene.known = known_within(22.0F);
  EXPECT_EQ(road.judge(95.3F, 0.0F, 2.0F).agent, kUnseen);
}

// GUARD-012 From 94.5 at 3 m/s we leave the zone after 3.2 s, and cannot stop before it. One seen 40 m before it at 8 m/s is
// there after 3.5 s at the earliest, and nobody behind it sooner, though it were 3.05 s from 20 + 26.56 m before it.
TEST(GuardUnseen, NobodyOvertakesWhoIsAheadInItsLane) {
  for (const bool anybody : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    if (anybody) road.other(56.0F, 8.0F);
    road.scene.known = known_within(std::hypot(24.0F, 5.5F), 94.5F);
    EXPECT_EQ(road.safe(94.5F, 3.0F, 0.0F), anybody);
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

// GUARD-012 Behind us somebody may come at 24.2 m/s in the lane we change into, 44.4 m beyond the edge: too near where that
// is 4 m behind us, not where it is 60.
// In our own lane it is its own business. One that follows us there at our speed is nearer.
TEST(GuardUnseen, SomebodyMayComeInTheLaneWeChangeInto) {
  for (const float radius_m : {5.0F, 60.0F}) {
    Change change;
    for (const LaneIndex lane : {0, 1}) change.map.lanes[lane].speed_limit_mps = 22.0F;
    change.scene.known = {{100.0F, 0.0F}, radius_m, 0, 1, {}};
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
// out, somebody may come by one of those: 101 m around us are known, so 0.9 m further off. At 33 m/s and 62 m before, that
// takes 4.8 s; with 0.5 m/s^2, and 1.5 from 3 s on, we are out after 5.1 s.
TEST(GuardUnseen, SomebodyMayComeByALaneThatWasLeftOut) {
  for (const std::uint8_t left_out : {std::uint8_t{0}, std::uint8_t{1}}) {
    SharedGround road(Priority::kFirstYields);
    road.map.lanes[road.zone().other_lane].speed_limit_mps = 30.0F;
    road.map.lanes_left_out = left_out;
    road.scene.known = known_within(101.0F);
    const Verdict verdict = road.judge(95.3F, 0.0F, 0.5F);
    EXPECT_EQ(verdict.agent, left_out > 0 ? kUnseen : 255);
    EXPECT_NEAR(verdict.from_s, left_out > 0 ? 4.8F : 0.0F, 0.1F);
  }
}

// GUARD-012 The road they come on is cut into two lanes just where the known ground begins, with 2 cm between
// them: whoever comes is there all the same.
TEST(GuardUnseen, AnEdgeBetweenTwoLanesIsSeen) {
  SharedGround road(Priority::kFirstYields);
  const LaneIndex other = road.zone().other_lane;
  const float edge_m = std::sqrt(22.0F * 22.0F - 4.7F * 4.7F);
  Lane& lane = road.map.lanes[other];
  lane.points[0] = {0.0F, -edge_m + 0.01F};
  lane.length_m = 300.0F + edge_m - 0.01F;
  const LaneIndex before = add_lane(road.map, {{0.0F, -100.0F}, {0.0F, -edge_m - 0.01F}});
  link(road.map, before, other);
  scene::ConflictZone& zone = road.zone();
  zone.other_entry_m = edge_m - 4.0F - 0.01F;
  zone.other_exit_m = zone.other_entry_m + 8.0F;
  road.scene.known = known_within(22.0F);
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
    change.scene.known = {{100.0F, 0.0F}, 60.0F, 0, 1, {}};
    add_vehicle(change.scene, change.map, path_of(change.map, {0}), 120.0F, 12.0F);  // nobody stands there
    add_vehicle(change.scene, change.map, path_of(change.map, {1}), 130.0F, 12.0F);
    if (winding) add_winding_lanes(change.map, 100.0F);
    EXPECT_EQ(change.judge(1).cause, winding ? Cause::kFollower : Cause::kNone);
    EXPECT_TRUE(change.judge(0).safe());
  }
}

}  // namespace
}  // namespace s4tp::safety
