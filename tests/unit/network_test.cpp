#include "sim_host/world/map/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/networks.hpp"

namespace s4tp::map {
namespace {

using test::kBridged;
using test::kCross;
using test::lane;
using test::network_of;
using test::replaced;
using test::shipped;

/// The conflict of two lanes as seen from the first one named.
std::optional<Conflict> conflict_of(const Network& network, const std::string& mine,
                                    const std::string& other) {
  const LaneId first = network.find(mine);
  const LaneId second = network.find(other);
  for (Conflict found : network.conflicts) {
    if (found.first == second && found.second == first) {
      std::swap(found.first, found.second);
      std::swap(found.first_entry_m, found.second_entry_m);
      std::swap(found.first_exit_m, found.second_exit_m);
      found.rule = found.rule == Rule::kFirstYields        ? Rule::kFirstHasPriority
                   : found.rule == Rule::kFirstHasPriority ? Rule::kFirstYields
                                                           : Rule::kFirstCome;
    }
    if (found.first == first && found.second == second) {
      return found;
    }
  }
  return std::nullopt;
}

// NET-002 Two boxes at right angles touch while both centres are within 2.5 + 0.9 + 2 * 0.1 = 3.6 m of the
// crossing at 10 m: 6.4 .. 13.6, sampled every 0.25 m: 6.5 .. 13.5. Who comes from the west yields.
TEST(Network, ACrossingIsWhereTwoBoxesTouch) {
  const Network network = network_of(kCross);
  ASSERT_EQ(network.conflicts.size(), 1U);
  const auto found = conflict_of(network, ":c_0_0", ":c_1_0");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rule, Rule::kFirstYields);
  EXPECT_DOUBLE_EQ(found->first_entry_m, 6.5);
  EXPECT_DOUBLE_EQ(found->first_exit_m, 13.5);
  EXPECT_DOUBLE_EQ(found->second_entry_m, 6.5);
  EXPECT_DOUBLE_EQ(found->second_exit_m, 13.5);
}

// NET-002 The same ground where the network says that the two are no foes: cars are what touches.
TEST(Network, GroundIsSharedWhateverTheNetworkSays) {
  const Network network =
      network_of(replaced(replaced(kCross, R"(foes="10")", R"(foes="00")"), R"(foes="01")", R"(foes="00")"));
  const auto found = conflict_of(network, ":c_0_0", ":c_1_0");
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->first_entry_m, 6.5);
  EXPECT_DOUBLE_EQ(found->second_exit_m, 13.5);
}

// NET-002 Both yield to each other (zipper, all-way stop), or neither does: whoever comes first.
TEST(Network, WithoutAnOrderWhoeverComesFirstGoes) {
  const Network both =
      network_of(replaced(kCross, R"(index="1" response="00")", R"(index="1" response="01")"));
  EXPECT_EQ(both.conflicts.at(0).rule, Rule::kFirstCome);
  const Network neither = network_of(replaced(kCross, R"(response="10")", R"(response="00")"));
  EXPECT_EQ(neither.conflicts.at(0).rule, Rule::kFirstCome);
}

// NET-002 With junction lanes of only 4 m a car still stands on the lane before when its nose reaches the
// other way: the zone starts 10 - 3.6 = 6.4 m along, thus on the lanes outside, and these are in conflict
// too.
TEST(Network, AZoneReachesOutOfASmallJunction) {
  std::string text = kCross;
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"-10,0 10,0\"", "\"-2,0 2,0\""},
                                                        {"\"0,-10 0,10\"", "\"0,-2 0,2\""},
                                                        {"-50,0 -10,0", "-50,0 -2,0"},
                                                        {"10,0 50,0", "2,0 50,0"},
                                                        {"0,-50 0,-10", "0,-50 0,-2"},
                                                        {"0,10 0,50", "0,2 0,50"}}) {
    text = replaced(text, from, to);
  }
  const Network network = network_of(text);
  const auto before = conflict_of(network, "west_in_0", ":c_1_0");
  ASSERT_TRUE(before);
  EXPECT_EQ(before->rule, Rule::kFirstYields);
  EXPECT_NEAR(before->first_entry_m, 48.0 - 1.6, 0.25);  // 3.6 m before the crossing, 2 m of them inside
  EXPECT_DOUBLE_EQ(before->first_exit_m, 48.0);
  EXPECT_TRUE(conflict_of(network, "east_out_0", ":c_1_0"));
}

// NET-002 The ego's left turn from the minor road of the cross: it yields to all of the main road and to who
// comes straight from opposite, not to the opposite left turn, which it does not even touch.
TEST(Network, TheLeftTurnYieldsWhereItShould) {
  const Network network = shipped("left_turn").network;
  const std::string ego = ":centre_9_0";
  ASSERT_EQ(lane(network, ego).successors, std::vector<LaneId>{network.find("west_out_1")});
  for (const char* main_road : {":centre_11_0", ":centre_11_1", ":centre_4_1"}) {
    ASSERT_TRUE(conflict_of(network, ego, main_road)) << main_road;
    EXPECT_EQ(conflict_of(network, ego, main_road)->rule, Rule::kFirstYields) << main_road;
  }
  ASSERT_TRUE(conflict_of(network, ego, ":centre_1_0"));
  EXPECT_EQ(conflict_of(network, ego, ":centre_1_0")->rule, Rule::kFirstYields);
  EXPECT_FALSE(conflict_of(network, ego, ":centre_2_0"));   // opposite left turn
  EXPECT_FALSE(conflict_of(network, ego, ":centre_8_0"));   // from the ego's own lane: they follow
  EXPECT_FALSE(conflict_of(network, ego, ":centre_10_0"));  // right turn from the west: far corner
}

// NET-002 Left from the main road against its opposing straight lanes: it yields, beyond the place inside the
// junction where it may wait (its second part), and has priority over the minor road.
TEST(Network, ALeftTurnInTwoPartsIsHandledInBoth) {
  const Network network = shipped("left_turn").network;
  const std::string waiting = ":centre_6_0";
  const std::string beyond = ":centre_14_0";
  ASSERT_EQ(lane(network, waiting).successors, std::vector<LaneId>{network.find(beyond)});
  for (const char* opposing : {":centre_11_0", ":centre_11_1"}) {
    ASSERT_TRUE(conflict_of(network, beyond, opposing));
    EXPECT_EQ(conflict_of(network, beyond, opposing)->rule, Rule::kFirstYields);
  }
  ASSERT_TRUE(conflict_of(network, beyond, ":centre_8_0"));
  EXPECT_EQ(conflict_of(network, beyond, ":centre_8_0")->rule, Rule::kFirstHasPriority);
  EXPECT_FALSE(conflict_of(network, waiting, ":centre_11_0"));  // there the outer lane is out of reach
}

// NET-002 The ego's turn merges into the inner lane with the main road's straight one: up to the end of both.
// The right turn from the north goes into the outer lane: no conflict.
TEST(Network, MergingLanesStayInConflictToTheirEnds) {
  const Network network = shipped("left_turn").network;
  const auto merge = conflict_of(network, ":centre_9_0", ":centre_4_1");
  ASSERT_TRUE(merge);
  EXPECT_DOUBLE_EQ(merge->first_exit_m, lane(network, ":centre_9_0").centre.length_m());
  EXPECT_DOUBLE_EQ(merge->second_exit_m, lane(network, ":centre_4_1").centre.length_m());
  EXPECT_FALSE(conflict_of(network, ":centre_9_0", ":centre_0_0"));
}

// The cross is the same from all sides: turned by 180 degrees every zone is found again with the same
// lengths.
TEST(Network, TheCrossIsSymmetric) {
  const Network network = shipped("left_turn").network;
  const auto north = conflict_of(network, ":centre_2_0", ":centre_4_1");   // north's left turn, from the east
  const auto south = conflict_of(network, ":centre_9_0", ":centre_11_1");  // south's left turn, from the west
  ASSERT_TRUE(north);
  ASSERT_TRUE(south);
  EXPECT_NEAR(north->first_entry_m, south->first_entry_m, 1e-3);
  EXPECT_NEAR(north->second_exit_m, south->second_exit_m, 1e-3);
}

// NET-002 Every zone of every shipped network lies on its lanes, is listed once, and touches a junction.
TEST(Network, ZonesLieOnTheirLanes) {
  for (const char* name : {"left_turn", "left_turn_t", "merge", "cruise"}) {
    const Network network = shipped(name).network;
    std::vector<std::pair<LaneId, LaneId>> seen;
    for (const Conflict& each : network.conflicts) {
      const Lane& first = network.lanes.at(static_cast<std::size_t>(each.first));
      const Lane& second = network.lanes.at(static_cast<std::size_t>(each.second));
      EXPECT_GE(each.first_entry_m, 0.0);
      EXPECT_LE(each.first_entry_m, each.first_exit_m);
      EXPECT_LE(each.first_exit_m, first.centre.length_m());
      EXPECT_GE(each.second_entry_m, 0.0);
      EXPECT_LE(each.second_entry_m, each.second_exit_m);
      EXPECT_LE(each.second_exit_m, second.centre.length_m());
      EXPECT_TRUE(first.in_junction || second.in_junction);
      seen.emplace_back(std::minmax(each.first, each.second));
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
  }
}

// The geometry of left_turn: arm 29.6 m, exit 42.8 m, a turn of about 16.85 m with a radius of about 10.7
// m.
TEST(Network, TheLeftTurnHasItsPublishedGeometry) {
  const Network network = shipped("left_turn").network;
  EXPECT_NEAR(lane(network, "south_in_0").centre.length_m(), 29.6, 0.01);
  EXPECT_NEAR(lane(network, "west_out_0").centre.length_m(), 42.8, 0.01);
  const Polyline& turn = lane(network, ":centre_9_0").centre;
  EXPECT_NEAR(turn.length_m(), 16.85, 0.1);
  for (double s = 1.0; s < 15.5; s += 0.5) {
    EXPECT_NEAR(turn.at(s).curvature_1pm, 1.0 / 10.7, 0.002) << s;
  }
}

// Ramp of 60 m and 4 m wide, 71 m of four lanes of which the right one ends, 70 m of three; at the seams one
// may go on changing lanes.
TEST(Network, TheMergeHasItsPublishedGeometry) {
  const Network network = shipped("merge").network;
  EXPECT_NEAR(lane(network, "ramp_0").centre.length_m(), 60.0, 0.01);
  EXPECT_EQ(lane(network, "ramp_0").width_m, 4.0);
  EXPECT_NEAR(lane(network, "merge_0").centre.length_m(), 71.0, 0.01);
  EXPECT_NEAR(lane(network, "main_out_2").centre.length_m(), 70.0, 0.01);
  EXPECT_TRUE(lane(network, "merge_0").successors.empty());
  EXPECT_EQ(lane(network, ":lane_end_0_0").left, network.find(":lane_end_0_1"));
}

// Where ways cross there is no changing lanes: the main road's two straight lanes are no neighbours inside.
TEST(Network, NoLaneChangesInsideACrossing) {
  const Network network = shipped("left_turn").network;
  EXPECT_EQ(lane(network, ":centre_11_0").left, kNoLane);
  EXPECT_EQ(lane(network, "west_in_0").left, network.find("west_in_1"));
}

// Missing attributes are SUMO's defaults: 3.2 m wide, 13.89 m/s.
TEST(Network, MissingAttributesAreSumosDefaults) {
  const Network network = network_of(
      replaced(kCross, R"(index="0" speed="10" length="40" shape="-50,0)", R"(index="0" shape="-50,0)"));
  EXPECT_EQ(lane(network, "west_in_0").width_m, 3.2);
  EXPECT_EQ(lane(network, "west_in_0").speed_limit_mps, 13.89);
}

// A sidewalk is no lane; the lane beside it keeps SUMO's number and loses the neighbour. A lane that only
// forbids trucks stays, and so does one with a height in its shape.
TEST(Network, LanesClosedToCarsAreLeftOut) {
  const Network network = network_of(R"(<net><edge id="road">
    <lane id="road_0" index="0" allow="pedestrian" shape="0,0 50,0"/>
    <lane id="road_1" index="1" disallow="truck" shape="0,3 50,3"/>
    <lane id="road_2" index="2" shape="0,6,1.5 50,6,1.5"/>
    <lane id="road_3" index="3" disallow="all" shape="0,9 50,9"/></edge></net>)");
  ASSERT_EQ(network.lanes.size(), 2U);
  EXPECT_EQ(lane(network, "road_1").index, 1);
  EXPECT_EQ(lane(network, "road_1").right, kNoLane);
  EXPECT_EQ(lane(network, "road_1").left, network.find("road_2"));
  EXPECT_EQ(lane(network, "road_2").left, kNoLane);
}

// A lane change the network forbids to cars is not offered.
TEST(Network, ForbiddenLaneChangesAreNotOffered) {
  const Network network = network_of(R"(<net><edge id="road">
    <lane id="road_0" index="0" changeLeft="emergency" shape="0,0 50,0"/>
    <lane id="road_1" index="1" shape="0,3 50,3"/></edge></net>)");
  EXPECT_EQ(lane(network, "road_0").left, kNoLane);
  EXPECT_EQ(lane(network, "road_1").right, network.find("road_0"));
}

// A junction lane no longer than a point, as netconvert writes at a mere bend, is passed over.
TEST(Network, JunctionLanesOfNoLengthArePassedOver) {
  const Network network = network_of(replaced(kCross, "\"-10,0 10,0\"", "\"-10,0 -10,0\""));
  EXPECT_EQ(network.find(":c_0_0"), kNoLane);
  EXPECT_EQ(lane(network, "west_in_0").successors, std::vector<LaneId>{network.find("east_out_0")});
}

// A network built without junction lanes gets arcs from lane to lane: here straight on, the 10 m between
// them.
TEST(Network, LoadsWithoutJunctionLanes) {
  const Network network = network_of(kBridged);
  EXPECT_EQ(lane(network, "a_0").successors, std::vector<LaneId>{network.find(":c_0_0")});
  EXPECT_EQ(lane(network, ":c_0_0").successors, std::vector<LaneId>{network.find("b_0")});
  EXPECT_NEAR(lane(network, ":c_0_0").centre.length_m(), 10.0, 1e-9);
  EXPECT_TRUE(network.conflicts.empty());
}

}  // namespace
}  // namespace s4tp::map
