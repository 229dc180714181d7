// Zones along a way, their groups, and where a car may stand between them.

#include "sim_host/world/judge/standing.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/networks.hpp"

namespace s4tp::judge {
namespace {

/// One lane of 100 m through a junction, and others that share 10 to 16 m, 14 to 20 m and from `third_m` to
/// 30 m of it.
map::Network with_zones(double third_m) {
  map::Network network;
  network.lanes.resize(4);
  for (map::Lane& lane : network.lanes) lane.centre = map::Polyline({{0.0, 0.0}, {100.0, 0.0}});
  network.conflicts = {{0, 1, map::Rule::kFirstYields, 10.0, 16.0, 0.0, 5.0},
                       {0, 2, map::Rule::kFirstHasPriority, 14.0, 20.0, 0.0, 5.0},
                       {0, 3, map::Rule::kFirstCome, third_m, 30.0, 0.0, 5.0}};
  return network;
}

constexpr std::array<Stretch, 1> kWay{{{0, 50.0, 0.0, 200.0}}};  // the lane begins at 50 m of the way

// LAW-004 The first two overlap: one group. 0.5 m between 20 and 20.5 are no place yet, 0.6 m are.
TEST(Standing, GroupsEndWhereACarCanStand) {
  const map::Network tight = with_zones(20.5);
  EXPECT_EQ(zone_groups(traffic::RoadIndex(tight), kWay, 5.0).size(), 1U);
  const map::Network wide = with_zones(20.6);
  const std::vector<ZoneGroup> groups = zone_groups(traffic::RoadIndex(wide), kWay, 5.0);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].entry_m, 60.0);
  EXPECT_EQ(groups[0].exit_m, 70.0);
  EXPECT_EQ(groups[0].zones.size(), 2U);
  EXPECT_EQ(groups[1].entry_m, 70.6);
}

// LAW-004 On a zone of any rule nobody may stand; before, between and behind everybody may.
TEST(Standing, OnNoZone) {
  const map::Network network = with_zones(25.0);
  const std::vector<ZoneGroup> groups = zone_groups(traffic::RoadIndex(network), kWay, 5.0);
  for (const double place_m : {59.9, 70.1, 74.9, 80.1}) EXPECT_TRUE(may_stand(groups, place_m)) << place_m;
  for (const double place_m : {60.1, 69.9, 79.9}) EXPECT_FALSE(may_stand(groups, place_m)) << place_m;
}

// A lorry of 12 m has its centre on the zone 3.5 m earlier and later: of the 5 m between them nothing is
// left.
TEST(Standing, LongCarsHaveLongerZones) {
  const map::Network network = with_zones(25.0);
  const std::vector<ZoneGroup> groups = zone_groups(traffic::RoadIndex(network), kWay, 12.0);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].entry_m, 56.5);
  EXPECT_EQ(groups[0].exit_m, 83.5);
}

// LAW-004 In left_turn nobody can wait between the lanes of the main road: south to west is one group from
// 0.7 m inside to the end of the turn.
TEST(Standing, TheLeftTurnIsOneGroup) {
  const scenario::Scenario scenario = test::shipped("left_turn");
  const map::LaneId turn = scenario.network.find(":centre_9_0");
  const std::array<Stretch, 1> way{{{turn, 0.0, -10.0, 30.0}}};
  const std::vector<ZoneGroup> groups = zone_groups(traffic::RoadIndex(scenario.network), way, 5.0);
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_NEAR(groups[0].entry_m, 0.7, 0.1);
}

}  // namespace
}  // namespace s4tp::judge
