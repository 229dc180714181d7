// Missions that no car can drive, and families by name.

#include "sim_host/roads/mission_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sim_host/roads/generator.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::roads {
namespace {

using test::kCross;
using test::replaced;

/// A mission over a network written as text.
std::string obstacle(const std::string& network, const std::string& start, const std::string& goal,
                     const std::string& more = {}) {
  const test::Folder folder;
  folder.write("net.xml", network);
  folder.write("scenario.toml", "[network]\nfile = \"net.xml\"\n[mission]\nstart_lane = \"" + start +
                                    "\"\ngoal_lane = \"" + goal + "\"\n" + more + "[traffic]\n");
  return obstacle_of(scenario::load_scenario(folder.path()));
}

/// Two lanes of 60 m that go on as one, from the left lane.
const std::string kDrop = R"(<net>
  <edge id=":m_0" function="internal"><lane id=":m_0_0" index="0" speed="10" length="1" shape="60,0 61,0"/></edge>
  <edge id="two" from="a" to="m">
    <lane id="two_0" index="0" speed="10" length="60" shape="0,-3 60,-3"/>
    <lane id="two_1" index="1" speed="10" length="60" shape="0,0 60,0"/>
  </edge>
  <edge id="one" from="m" to="b"><lane id="one_0" index="0" speed="10" length="40" shape="61,0 101,0"/></edge>
  <connection from="two" to="one" fromLane="1" toLane="0" via=":m_0_0"/>
  <connection from=":m_0" to="one" fromLane="0" toLane="0"/>
</net>)";

// Straight over the crossing: arms of 40 m, no change, 100 m at 10 m/s are 10 of 80 s.
TEST(MissionCheck, FindsNothingWrongWithAnOrdinaryMission) {
  EXPECT_EQ(obstacle(kCross, "west_in_0", "east_out_0"), "");
}

// ROAD-003 An arm of 24 m is shorter than 25 m by more than netconvert rounds.
TEST(MissionCheck, AsksForArmsOf25Metres) {
  const std::string network =
      replaced(kCross, "length=\"40\" shape=\"10,0 50,0\"", "length=\"24\" shape=\"10,0 34,0\"");
  EXPECT_EQ(obstacle(network, "west_in_0", "east_out_0"), "an arm shorter than 25 m");
}

// ROAD-003 The road that comes from the right is 4 m long, a car 5 m.
TEST(MissionCheck, AsksForEdgesAsLongAsACar) {
  const std::string network =
      replaced(kCross, "length=\"40\" shape=\"0,-50 0,-10\"", "length=\"4\" shape=\"0,-14 0,-10\"");
  EXPECT_EQ(obstacle(network, "west_in_0", "east_out_0"), "an edge shorter than a car");
}

// ROAD-003 One change is due within 60 m: from 5 m there are 55 m left, from 41 m only 19 m of the 20 m asked
// for.
TEST(MissionCheck, AsksForRoomForEachLaneChange) {
  EXPECT_EQ(obstacle(kDrop, "two_0", "one_0"), "");
  EXPECT_EQ(obstacle(kDrop, "two_0", "one_0", "start_pos_m = 41.0\n"), "no room for its lane changes");
  EXPECT_EQ(obstacle(kDrop, "two_1", "one_0", "start_pos_m = 41.0\n"), "");
}

// ROAD-003 A right angle round a corner of 4 m cannot be driven by a car that turns on 4.7 m; round one of 8
// m it can.
TEST(MissionCheck, AsksForCornersACarCanTurn) {
  const auto corner = [](double radius_m) {
    std::string shape = "0,0 40,0";
    for (int i = 1; i <= 12; ++i) {
      const double t = 0.5 * 3.14159265358979 * i / 12;
      shape += ' ' + std::to_string(40.0 + radius_m * std::sin(t)) + ',' +
               std::to_string(radius_m * (1.0 - std::cos(t)));
    }
    shape += ' ' + std::to_string(40.0 + radius_m) + ",60";
    return "<net><edge id=\"e\" from=\"a\" to=\"b\"><lane id=\"e_0\" index=\"0\" speed=\"10\" length=\"90\" "
           "shape=\"" +
           shape + "\"/></edge></net>";
  };
  EXPECT_EQ(obstacle(corner(4.0), "e_0", "e_0"), "a corner tighter than the car");
  EXPECT_EQ(obstacle(corner(8.0), "e_0", "e_0"), "");
}

// ROAD-003 95 m from 5 m on take 10 s at 10 m/s: more than half of 18 s, less than half of 22 s.
TEST(MissionCheck, AsksForTwiceTheTimeOfAFreeDrive) {
  EXPECT_EQ(obstacle(kCross, "west_in_0", "east_out_0", "time_limit_s = 18.0\n"), "too long for its time");
  EXPECT_EQ(obstacle(kCross, "west_in_0", "east_out_0", "time_limit_s = 22.0\n"), "");
}

// ROAD-004 Roads of a family differ in their number only; shipped scenarios are families of their own.
TEST(RoadFamily, IsTheNameWithoutItsNumber) {
  EXPECT_EQ(family_of("ramp_junction_00021"), "ramp_junction");
  EXPECT_EQ(family_of("cruise_7"), "cruise");
  EXPECT_EQ(family_of("left_turn"), "left_turn");
  EXPECT_EQ(family_of("lane2"), "lane2");
  EXPECT_EQ(family_of("_12"), "_12");
  EXPECT_EQ(family_of("12"), "12");
}

}  // namespace
}  // namespace s4tp::roads
