// The shortest legal way to every lane, on small maps.

#include "algo/occupancy/lane_reach.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/driving_scenes.hpp"

namespace s4tp::occupancy {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// A vehicle at `s_m` of the first lane of a path.
scene::Agent vehicle_on(const LaneMap& map, const scene::LanePath& path, float s_m) {
  scene::Scene scene;
  return add_vehicle(scene, map, path, s_m, 5.0F);
}

LaneReach reach_of(const LaneMap& map, const scene::Agent& agent) {
  LaneReach reach;
  reach.measure(map, agent);
  return reach;
}

// OCC-003 30 m into a lane of 52 m it is 22 m from each of the three turns behind it, though its own paths
// name only one; 30 m past its own lane's start. Lanes it cannot come to have no way.
TEST(LaneReach, EveryTurnCountsWhateverIsLikely) {
  const CrossJunction cross = cross_junction();
  const LaneIndex in = cross.in[CrossJunction::kEast];
  const LaneIndex ahead = cross.connection[CrossJunction::kEast][CrossJunction::kStraight];
  const LaneReach reach = reach_of(cross.map, vehicle_on(cross.map, path_of(cross.map, {in, ahead}), 30.0F));
  EXPECT_NEAR(reach.to_start_m(in), -30.0F, 0.01F);
  for (const LaneIndex turn : cross.connection[CrossJunction::kEast])
    EXPECT_NEAR(reach.to_start_m(turn), 22.0F, 0.01F) << int{turn};
  const LaneIndex right = cross.connection[CrossJunction::kEast][CrossJunction::kRight];
  EXPECT_NEAR(reach.to_start_m(cross.out[CrossJunction::kSouth]), 22.0F + cross.map.lanes[right].length_m,
              0.02F);
  EXPECT_EQ(reach.to_start_m(cross.in[CrossJunction::kNorth]), kNoWayM);
  EXPECT_EQ(reach.to_start_m(cross.connection[CrossJunction::kWest][CrossJunction::kLeft]), kNoWayM);
}

// OCC-004 On no lane of the map, 50 m from where the western arm's lane begins: where the map left lanes out it may
// come by one of those into that lane and all that follow, but into no lane that others lead to; else nowhere.
TEST(LaneReach, WhoIsOnNoLaneMayBeOnOneThatWasLeftOut) {
  CrossJunction cross = cross_junction();
  const LaneIndex in = cross.in[CrossJunction::kEast];
  const LaneIndex ahead = cross.connection[CrossJunction::kEast][CrossJunction::kStraight];
  scene::Agent vehicle;
  const Point start = cross.map.lanes[in].points[0];
  vehicle.track.centre = {start.x_m - 30.0F, start.y_m - 40.0F, 1.0F};
  EXPECT_EQ(reach_of(cross.map, vehicle).to_start_m(in), kNoWayM);
  cross.map.lanes_left_out = 1;
  EXPECT_NEAR(reach_of(cross.map, vehicle).to_start_m(in), 50.0F, 0.02F);
  EXPECT_NEAR(reach_of(cross.map, vehicle).to_start_m(ahead), 50.0F + cross.map.lanes[in].length_m, 0.02F);
  // Straight it were 30 m nearer to the end of the western arm than by the way through the junction.
  EXPECT_GT(
      reach_of(cross.map, vehicle).to_start_m(cross.out[CrossJunction::kWest]),
      distance(position(vehicle.track.centre), cross.map.lanes[cross.out[CrossJunction::kWest]].points[0]));
}

// OCC-004 The same 50 m, driven at 14 m/s: straight away from there it takes 2 s to stand at 7 m/s^2, 14 m further on, and at least
// sqrt(2 * 64 / 7) = 4.28 s back, 88 m at that speed; straight towards it 50 m; standing 50 m, wherever it looks.
TEST(LaneReach, WhoDrivesAwayHasToTurnFirst) {
  CrossJunction cross = cross_junction();
  cross.map.lanes_left_out = 1;
  const LaneIndex in = cross.in[CrossJunction::kEast];
  scene::Agent vehicle;
  const Point start = cross.map.lanes[in].points[0];
  const auto way_m = [&](float heading_rad, float speed_mps) {
    vehicle.track.centre = {start.x_m, start.y_m - 50.0F, heading_rad};
    vehicle.track.speed_mps = speed_mps;
    return reach_of(cross.map, vehicle).to_start_m(in);
  };
  EXPECT_NEAR(way_m(-0.5F * kPi, 14.0F), 14.0F * (2.0F + std::sqrt(128.0F / 7.0F)), 0.05F);
  EXPECT_NEAR(way_m(0.5F * kPi, 14.0F), 50.0F, 0.02F);
  EXPECT_NEAR(way_m(-0.5F * kPi, 0.0F), 50.0F, 0.02F);
}

// OCC-003 100 m of two lanes, and a third behind the left one: from the right lane at 40 m it is 60 m, by a
// change on the way; not from 95 m, where 5 m are too little for a change.
TEST(LaneReach, ALaneChangeIsAWay) {
  LaneMap map = straight_road(2, 100.0F);
  const LaneIndex exit = add_lane(map, {{100.0F, kLaneWidthM}, {200.0F, 40.0F}});
  link(map, 1, exit);
  EXPECT_NEAR(reach_of(map, vehicle_on(map, path_of(map, {0}), 40.0F)).to_start_m(exit), 60.0F, 0.01F);
  EXPECT_NEAR(reach_of(map, vehicle_on(map, path_of(map, {0}), 40.0F)).to_start_m(1), -40.0F, 0.01F);
  EXPECT_EQ(reach_of(map, vehicle_on(map, path_of(map, {0}), 95.0F)).to_start_m(exit), kNoWayM);
}

// OCC-003 Two ways lead to a lane, one of 30 m, one of 80 m: the shorter one counts, whichever is looked at
// first.
TEST(LaneReach, TheShorterWayCounts) {
  for (const bool long_first : {false, true}) {
    LaneMap map = straight_road(1, 50.0F);
    const LaneIndex near = add_lane(map, {{50.0F, 0.0F}, {70.0F, 0.0F}});
    const LaneIndex detour = add_lane(map, {{50.0F, 0.0F}, {60.0F, 33.5410197F}, {70.0F, 0.0F}});
    const LaneIndex goal = add_lane(map, {{70.0F, 0.0F}, {90.0F, 0.0F}});
    for (const LaneIndex middle : {long_first ? detour : near, long_first ? near : detour}) {
      link(map, 0, middle);
      link(map, middle, goal);
    }
    EXPECT_NEAR(reach_of(map, vehicle_on(map, path_of(map, {0}), 40.0F)).to_start_m(goal), 30.0F, 0.01F);
  }
}

// OCC-003 A ring of two lanes ends, and 170 m are further than anybody can see.
TEST(LaneReach, RingsAndFarLanes) {
  LaneMap ring = straight_road(1, 20.0F);
  const LaneIndex back = add_lane(ring, {{20.0F, 0.0F}, {20.0F, 5.0F}, {0.0F, 5.0F}, {0.0F, 0.0F}});
  link(ring, 0, back);
  link(ring, back, 0);
  const LaneReach reach = reach_of(ring, vehicle_on(ring, path_of(ring, {0}), 5.0F));
  EXPECT_NEAR(reach.to_start_m(0), -5.0F, 0.01F);
  EXPECT_NEAR(reach.to_start_m(back), 15.0F, 0.01F);
  LaneMap road = straight_road(1, 180.0F);
  const LaneIndex far = add_lane(road, {{180.0F, 0.0F}, {200.0F, 0.0F}});
  link(road, 0, far);
  EXPECT_EQ(reach_of(road, vehicle_on(road, path_of(road, {0}), 10.0F)).to_start_m(far), kNoWayM);
}

// OCC-003 Who is on no lane, or whose place is not a number, reaches none.
TEST(LaneReach, WhoIsNowhereReachesNothing) {
  const LaneMap map = straight_road(2, 100.0F);
  EXPECT_EQ(reach_of(map, scene::Agent{}).to_start_m(0), kNoWayM);
  scene::Agent lost = vehicle_on(map, path_of(map, {0}), 40.0F);
  lost.frenet[0].s_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(reach_of(map, lost).to_start_m(0), kNoWayM);
}

}  // namespace
}  // namespace s4tp::occupancy
