#include "sim_host/world/nodes/map_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "tests/support/networks.hpp"

namespace s4tp::nodes {
namespace {

using map::Network;
using test::lane;
using test::network_of;
using test::shipped;

double length_m(const wire::Lane& lane) {
  double sum = 0.0;
  for (int i = 1; i < lane.point_count; ++i) {
    sum += std::hypot(static_cast<double>(lane.x_m[i]) - static_cast<double>(lane.x_m[i - 1]),
                      static_cast<double>(lane.y_m[i]) - static_cast<double>(lane.y_m[i - 1]));
  }
  return sum;
}

/// Slot of the present lane whose first vertex lies at a point (map frame), or 127.
std::uint8_t slot_at(const wire::Map& map, double x_m, double y_m) {
  for (std::uint8_t i = 0; i < wire::kMaxLanes; ++i) {
    const wire::Lane& lane = map.lanes[i];
    if (lane.present &&
        std::hypot(static_cast<double>(lane.x_m[0]) - x_m, static_cast<double>(lane.y_m[0]) - y_m) < 0.01) {
      return i;
    }
  }
  return wire::kNoLane;
}

int lane_count(const wire::Map& map) {
  return static_cast<int>(std::count_if(std::begin(map.lanes), std::end(map.lanes),
                                        [](const auto& lane) { return lane.present; }));
}

/// A road of `lanes` lanes and `length_m` that bends every 50 m, 3 m to the left and back.
std::string winding_road(int lanes, int length_m) {
  std::string text = "<net><edge id=\"road\">";
  for (int index = 0; index < lanes; ++index) {
    text +=
        "<lane id=\"road_" + std::to_string(index) + "\" index=\"" + std::to_string(index) + "\" shape=\"";
    for (int x = 0; x <= length_m; x += 50) {
      text += std::to_string(x) + "," + std::to_string(3 * index + (x / 50 % 2) * 3) + " ";
    }
    text += "\"/>";
  }
  return text + "</edge></net>";
}

/// The map of a shipped scenario around a point; what it refers to lives as long as it.
struct Shown {
  explicit Shown(const char* name, map::Vec2 origin = {})
      : scenario(shipped(name)),
        guide(scenario::mission_guide(scenario)),
        node(scenario.network, guide, origin) {}
  scenario::Scenario scenario;
  map::RouteGuide guide;
  MapNode node;
};

// The ego's arm starts at (1.6, -38.7), leads on by three ways of which the left turn is the route's, has a
// stop line at its end after 29.6 m, and 89.2 m to go.
TEST(MapNode, ShowsTheLaneWithWhatBelongsToIt) {
  Shown shown("left_turn");
  const wire::Map& map = shown.node.update({1.6, -33.7});
  const std::uint8_t slot = slot_at(map, 1.6, -38.7);
  ASSERT_NE(slot, wire::kNoLane);
  const wire::Lane& arm = map.lanes[slot];
  EXPECT_TRUE(arm.on_route);
  EXPECT_EQ(arm.kind, 0);
  EXPECT_FALSE(arm.in_junction);
  EXPECT_EQ(arm.point_count, 2);
  EXPECT_FLOAT_EQ(arm.width_m, 3.2F);
  EXPECT_NEAR(arm.stop_line_m, 29.6F, 1e-3F);
  EXPECT_NEAR(arm.goal_distance_m, 89.2F, 0.01F);
  const wire::Lane& turn = map.lanes[arm.successors[0]];
  EXPECT_TRUE(turn.in_junction);
  EXPECT_TRUE(turn.on_route);
  EXPECT_NEAR(turn.speed_limit_mps, 8.67F, 1e-3F);
  EXPECT_LT(turn.stop_line_m, 0.0F);
  EXPECT_FALSE(map.lanes[arm.successors[1]].on_route);
  const wire::Lane& inner = map.lanes[turn.successors[0]];
  EXPECT_EQ(inner.changes_needed, -1);
  EXPECT_EQ(inner.left, wire::kNoLane);
  EXPECT_EQ(map.lanes[inner.right].changes_needed, 0);
}

// Positions are relative to the origin of the odometry frame.
TEST(MapNode, PositionsAreRelativeToTheOrigin) {
  Shown shown("left_turn", {1.6, -33.7});
  const wire::Map& map = shown.node.update({1.6, -33.7});
  EXPECT_NE(slot_at(map, 0.0, -5.0), wire::kNoLane);
}

// Against us: the south arm's other lane, and the lanes of the west side that lead to the junction. Ours: the
// north and east exits (a missed turn), and the main road's lanes from the east, which lead straight onto the
// route.
TEST(MapNode, KnowsWhichLanesLeadAgainstUs) {
  Shown shown("left_turn");
  const wire::Map& map = shown.node.update({0.0, 0.0});
  EXPECT_EQ(map.lanes[slot_at(map, -1.6, -9.1)].kind, 1);   // south_out
  EXPECT_EQ(map.lanes[slot_at(map, -89.1, -1.6)].kind, 1);  // west_in_1
  EXPECT_EQ(map.lanes[slot_at(map, -1.6, 89.1)].kind, 1);   // north_in
  EXPECT_EQ(map.lanes[slot_at(map, -9.1, 4.8)].kind, 0);    // west_out_0
  EXPECT_EQ(map.lanes[slot_at(map, 9.1, -1.6)].kind, 0);    // east_out_1
  EXPECT_EQ(map.lanes[slot_at(map, 89.1, 1.6)].kind, 0);    // east_in_1
}

// MAP-001 Along the whole drive every lane that stays keeps its slot, and every conflict too.
TEST(MapNode, SlotsAreStableWhileMoving) {
  const Network network = network_of(winding_road(3, 3000));
  const map::RouteGuide guide(network, {"road"}, map::kNoLane, 3000.0);
  MapNode node(network, guide, {});
  wire::Map before = node.update({0.0, 0.0});
  int kept = 0;
  int moved_on = 0;
  for (double x = 10.0; x <= 2000.0; x += 10.0) {
    const wire::Map now = node.update({x, 0.0});
    for (std::uint8_t i = 0; i < wire::kMaxLanes; ++i) {
      if (!before.lanes[i].present) {
        continue;
      }
      const double x_m = static_cast<double>(before.lanes[i].x_m[0]);
      const double y_m = static_cast<double>(before.lanes[i].y_m[0]);
      const std::uint8_t slot = slot_at(now, x_m, y_m);
      if (slot == wire::kNoLane) {
        ++moved_on;
      } else {
        EXPECT_EQ(slot, i) << x;
        ++kept;
      }
    }
    before = now;
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(moved_on, 15);
}

// MAP-001 At the edge of the horizon a lane does not come and go: once shown within 150 m it stays until 160
// m.
TEST(MapNode, LanesDoNotFlickerAtTheHorizon) {
  Shown shown("cruise");
  EXPECT_EQ(lane_count(shown.node.update({-155.0, 0.0})), 0);
  EXPECT_EQ(lane_count(shown.node.update({-149.0, 0.0})), 3);
  EXPECT_EQ(lane_count(shown.node.update({-155.0, 0.0})), 3);
  EXPECT_EQ(lane_count(shown.node.update({-165.0, 0.0})), 0);
}

// MAP-002 3000 m of bends are sent in parts of at most 12 vertices and 250 m; each is the successor of the
// one before and starts where that one ends, neighbours lie beside each other, and goal distances go on.
TEST(MapNode, LongLanesAreSentInParts) {
  const Network network = network_of(winding_road(2, 3000));
  const map::RouteGuide guide(network, {"road"}, map::kNoLane, network.lanes[0].centre.length_m());
  MapNode node(network, guide, {}, 1000.0);
  const wire::Map& map = node.update({0.0, 0.0});
  std::uint8_t at = slot_at(map, 0.0, 0.0);
  ASSERT_NE(at, wire::kNoLane);
  int parts = 0;
  for (; map.lanes[at].successors[0] != wire::kNoLane; ++parts) {
    const wire::Lane& part = map.lanes[at];
    const wire::Lane& next = map.lanes[part.successors[0]];
    EXPECT_LE(length_m(part), 250.1);
    EXPECT_EQ(part.x_m[part.point_count - 1], next.x_m[0]);
    EXPECT_EQ(part.y_m[part.point_count - 1], next.y_m[0]);
    EXPECT_NEAR(part.goal_distance_m - static_cast<float>(length_m(part)), next.goal_distance_m, 0.05F);
    const wire::Lane& left = map.lanes[part.left];
    EXPECT_NEAR(left.x_m[0], part.x_m[0], 1.0F);
    EXPECT_NEAR(left.y_m[0], part.y_m[0] + 3.0F, 0.2F);
    at = part.successors[0];
  }
  EXPECT_EQ(parts, 4);  // parts that start within 1000 m: 5
}

// NET-004 A lane of 2 km that zigzags in its first two metres is no 6000 parts: the map around it holds a few, each as near to
// it as 12 vertices can be.
TEST(MapNode, ALaneThatBendsOftenHasFewParts) {
  std::string text = "<net><edge id=\"road\"><lane id=\"road_0\" index=\"0\" shape=\"";
  for (int i = 0; i < 40; ++i) text += std::to_string(0.05 * i) + "," + std::to_string(i % 2) + " ";
  const Network network = network_of(text + "2000,0\"/></edge></net>");
  const map::RouteGuide guide(network, {"road"}, map::kNoLane, 2000.0);
  MapNode node(network, guide, {});
  const wire::Map& map = node.update({0.0, 0.0});
  EXPECT_LE(lane_count(map), 5);
  const std::uint8_t first = slot_at(map, 0.0, 0.0);
  ASSERT_NE(first, wire::kNoLane);
  EXPECT_LE(map.lanes[first].point_count, wire::kMaxLanePoints);
}

// NET-004 Two lanes inside a junction that lead into each other, and into a lane in conflict with our way: the search for where
// it is entered from went round for ever.
TEST(MapNode, LanesThatLeadIntoEachOtherAreNoWayWithoutEnd) {
  std::string text = test::replaced(test::kCross, "\"0,-10 0,10\"", "\"0,-10 0,-1\"");
  const std::string south = R"(<connection from=":c_1" to="north_out" fromLane="0" toLane="0"/>)";
  text = test::replaced(text, south, R"(
    <connection from=":c_1" to="north_out" fromLane="0" toLane="0" via=":c_5_0"/>
    <connection from=":c_5" to="north_out" fromLane="0" toLane="0"/>
    <connection from=":c_0a" to="north_out" fromLane="0" toLane="0" via=":c_5_0"/>
    <connection from=":c_0a" to="north_out" fromLane="0" toLane="0" via=":c_0b_0"/>
    <connection from=":c_0b" to="north_out" fromLane="0" toLane="0" via=":c_0a_0"/>)");
  text = test::replaced(text, "<net>", R"(<net>
    <edge id=":c_0a" function="internal"><lane id=":c_0a_0" index="0" shape="-3,-9 -3,-1"/></edge>
    <edge id=":c_0b" function="internal"><lane id=":c_0b_0" index="0" shape="-3,-1 -3,-9"/></edge>
    <edge id=":c_5" function="internal"><lane id=":c_5_0" index="0" shape="0,-1 0,10"/></edge>)");
  const Network network = network_of(text);
  const map::LaneId crossed = network.find(":c_5_0");
  ASSERT_EQ(lane(network, ":c_5_0").predecessors.front(), network.find(":c_0a_0"));
  ASSERT_TRUE(std::any_of(network.conflicts.begin(), network.conflicts.end(), [&](const map::Conflict& each) {
    return each.first == crossed || each.second == crossed;
  }));
  const map::RouteGuide guide(network, {"west_in", "east_out"}, map::kNoLane, 40.0);
  MapNode node(network, guide, {});
  EXPECT_GE(lane_count(node.update({-30.0, 0.0})), 9);
}

// MAP-002 Vertices sent stay within 0.03 m of the lane, and zones lie on the vertices' arc length: none ends
// beyond it, and the merging ones end with it.
TEST(MapNode, ArcLengthsAreThoseOfTheVerticesSent) {
  Shown shown("left_turn");
  const wire::Map& map = shown.node.update({0.0, 0.0});
  int merging = 0;
  for (const wire::Conflict& conflict : map.conflicts) {
    if (!conflict.present) {
      continue;
    }
    const double first_m = length_m(map.lanes[conflict.first]);
    const double second_m = length_m(map.lanes[conflict.second]);
    EXPECT_LE(static_cast<double>(conflict.first_exit_m), first_m + 1e-3);
    EXPECT_LE(static_cast<double>(conflict.second_exit_m), second_m + 1e-3);
    const bool merge = map.lanes[conflict.first].successors[0] == map.lanes[conflict.second].successors[0];
    if (merge) {
      ++merging;
      EXPECT_NEAR(static_cast<double>(conflict.first_exit_m), first_m, 1e-3);
      EXPECT_NEAR(static_cast<double>(conflict.second_exit_m), second_m, 1e-3);
    }
  }
  // Two ways into each of the main road's four lanes: 4 pairs; three into each minor exit: 3 pairs twice.
  EXPECT_EQ(merging, 10);
  const map::Polyline& turn = lane(shown.scenario.network, ":centre_9_0").centre;
  const wire::Lane& sent = map.lanes[map.lanes[slot_at(map, 1.6, -38.7)].successors[0]];
  std::vector<map::Vec2> points;
  for (int i = 0; i < sent.point_count; ++i) {
    points.push_back({static_cast<double>(sent.x_m[i]), static_cast<double>(sent.y_m[i])});
  }
  for (const map::Vec2& vertex : turn.points()) {
    EXPECT_LE(std::abs(map::Polyline(points).project(vertex).d_m), 0.031);
  }
}

// MAP-002 A zone over the border of two parts is told for both: a straight lane of 400 m is sent as 2 x 200
// m, the crossing at its middle covers 196.4 .. 203.6 m, thus the last 3.6 m of the one and the first 3.6 m
// of the other.
TEST(MapNode, AZoneOverABorderIsToldForBothParts) {
  std::string text = test::kCross;
  text = test::replaced(text, "\"-10,0 10,0\"", "\"-200,0 200,0\"");
  text = test::replaced(text, "-50,0 -10,0", "-250,0 -200,0");
  text = test::replaced(text, "10,0 50,0", "200,0 250,0");
  const Network network = network_of(text);
  const map::RouteGuide guide(network, {"west_in", "east_out"}, map::kNoLane, 50.0);
  MapNode node(network, guide, {});
  const wire::Map& map = node.update({0.0, 0.0});
  int found = 0;
  for (const wire::Conflict& conflict : map.conflicts) {
    if (!conflict.present) {
      continue;
    }
    const bool first_part = map.lanes[conflict.first].x_m[0] < -100.0F;
    EXPECT_NEAR(conflict.first_entry_m, first_part ? 196.4F : 0.0F, 0.3F);
    EXPECT_NEAR(conflict.first_exit_m, first_part ? 200.0F : 3.6F, 0.3F);
    EXPECT_NEAR(conflict.second_entry_m, 6.4F, 0.3F);
    ++found;
  }
  EXPECT_EQ(found, 2);
}

// MAP-003 Of 3 lanes of the route and 80 of others, the route's come first, then the nearest, and 19 are left
// out.
TEST(MapNode, TheRouteComesFirstWhenSlotsAreFew) {
  std::string text = "<net>";
  const auto add = [&](const std::string& edge, int index, double y) {
    text += "<lane id=\"" + edge + "_" + std::to_string(index) + "\" index=\"" + std::to_string(index) +
            "\" shape=\"0," + std::to_string(y) + " 100," + std::to_string(y) + "\"/>";
  };
  for (int i = 0; i < 80; ++i) {
    text += "<edge id=\"other" + std::to_string(i) + "\">";
    add("other" + std::to_string(i), 0, 0.5 * i);
    text += "</edge>";
  }
  text += "<edge id=\"road\">";
  for (int i = 0; i < 3; ++i) {
    add("road", i, 100.0 + 3.0 * i);
  }
  const Network network = network_of(text + "</edge></net>");
  const map::RouteGuide guide(network, {"road"}, map::kNoLane, 100.0);
  MapNode node(network, guide, {});
  const wire::Map& map = node.update({50.0, 0.0});
  EXPECT_EQ(lane_count(map), wire::kMaxLanes);
  EXPECT_EQ(map.lanes_left_out, 83 - 64);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NE(slot_at(map, 0.0, 100.0 + 3.0 * i), wire::kNoLane);
  }
  EXPECT_NE(slot_at(map, 0.0, 0.5 * 60), wire::kNoLane);
  EXPECT_EQ(slot_at(map, 0.0, 0.5 * 61), wire::kNoLane);
}

}  // namespace
}  // namespace s4tp::nodes
