// How much of its lanes the ego's box takes, as SUMO is told.

#include "sim_host/sumo/ego_reach.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace s4tp::sumo {
namespace {

/// Lane 0 east to x = 50, lane 1 around a corner without a radius, 2 m and 2 m, lane 2 south from there; lane 3 leads to none of them.
map::Network sharp_corner() {
  const auto lane = [](std::vector<map::Vec2> points, std::vector<map::LaneId> successors) {
    map::Lane result;
    result.drawn = result.centre = map::Polyline(points);
    result.successors = std::move(successors);
    return result;
  };
  map::Network network;
  network.lanes = {lane({{0.0, 0.0}, {50.0, 0.0}}, {1}), lane({{50.0, 0.0}, {52.0, 0.0}, {52.0, -2.0}}, {2}),
                   lane({{52.0, -2.0}, {52.0, -50.0}}, {}), lane({{0.0, 3.2}, {50.0, 3.2}}, {})};
  return network;
}

traffic::CarState placed(double x, double y, double heading_rad) {
  traffic::CarState car;
  car.centre = {x, y};
  car.heading_rad = heading_rad;
  return car;
}

// SUMO-006 On a straight lane a box takes its 5 m.
TEST(EgoReach, AsLongAsItIsOnAStraightLane) {
  const map::Network network = sharp_corner();
  EgoReach reach(network);
  reach.follow(0);
  EXPECT_DOUBLE_EQ(reach.length_m(placed(20.0, 0.3, 0.0)), 5.0);
}

// SUMO-006 Across the corner, turned by 45 degrees: the front 0.47 m along lane 2, 0.27 m beside it, the rear 48.73 m along lane 0: 0.47 + 4 +
// 1.27 = 5.74 m. Within 0.3 m of that the front may be taken for 0.5 m further on.
TEST(EgoReach, LongerAcrossASharpTurn) {
  const map::Network network = sharp_corner();
  EgoReach reach(network);
  for (const map::LaneId lane : {0, 1, 2}) reach.follow(lane);
  const double length_m = reach.length_m(placed(50.5, -0.7, -0.25 * std::numbers::pi));
  EXPECT_GE(length_m, 5.73);
  EXPECT_LE(length_m, 5.73 + 0.52);
}

// SUMO-006 Lanes that do not lead to each other are no way: after a lane change only the new one counts, and none where it is off the road.
TEST(EgoReach, CountsTheWayItCameBy) {
  const map::Network network = sharp_corner();
  EgoReach reach(network);
  const traffic::CarState across = placed(50.5, -0.7, -0.25 * std::numbers::pi);
  for (const map::LaneId lane : {0, 1, 2, 3}) reach.follow(lane);
  EXPECT_DOUBLE_EQ(reach.length_m(across), 5.0);
  for (const map::LaneId lane : {0, 1, 2, map::kNoLane}) reach.follow(lane);
  EXPECT_DOUBLE_EQ(reach.length_m(across), 5.0);
}

}  // namespace
}  // namespace s4tp::sumo
