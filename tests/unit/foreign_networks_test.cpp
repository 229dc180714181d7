// Networks as others draw them (tests/networks, made by its build.py): every kind of junction without
// signals, and with; turned, far from the origin, with strange names, without lanes inside junctions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim_host/world/map/lane_roles.hpp"
#include "sim_host/world/nodes/map_node.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::map {
namespace {

using test::lane;

std::filesystem::path folder() {
  return std::filesystem::path(S4TP_SOURCE_DIR) / "tests" / "networks";
}

scenario::Scenario foreign(const std::string& name, const std::string& flavour = {}) {
  return scenario::load_scenario(folder() / (name + ".toml"), flavour);
}

/// From an edge through the junction to another.
struct Turn {
  std::string from;
  std::string to;
};

std::vector<LaneId> inside(const Network& network, const Turn& turn) {
  std::vector<LaneId> all;
  for (const LaneId start : network.lanes_of(turn.from)) {
    for (LaneId at : network.lanes[static_cast<std::size_t>(start)].successors) {
      std::vector<LaneId> way;
      while (network.lanes[static_cast<std::size_t>(at)].in_junction) {
        way.push_back(at);
        at = network.lanes[static_cast<std::size_t>(at)].successors.at(0);
      }
      if (network.lanes[static_cast<std::size_t>(at)].edge == turn.to) {
        all.insert(all.end(), way.begin(), way.end());
      }
    }
  }
  return all;
}

/// What the first turn owes the second one, wherever they meet; nothing: they do not meet, or not always
/// alike.
std::optional<Rule> rule_between(const Network& network, const Turn& first, const Turn& second) {
  std::optional<Rule> rule;
  for (const LaneId mine : inside(network, first)) {
    for (const LaneId other : inside(network, second)) {
      for (const Conflict& each : network.conflicts) {
        const bool turned = each.first == other && each.second == mine;
        if (!turned && !(each.first == mine && each.second == other)) {
          continue;
        }
        const Rule here = !turned || each.rule == Rule::kFirstCome ? each.rule
                          : each.rule == Rule::kFirstYields        ? Rule::kFirstHasPriority
                                                                   : Rule::kFirstYields;
        if (rule && *rule != here) {
          return std::nullopt;
        }
        rule = here;
      }
    }
  }
  return rule;
}

bool stops_before(const scenario::Scenario& scenario, const std::string& name) {
  return yields_at_end(scenario.network, scenario::mission_guide(scenario), scenario.network.find(name));
}

/// A T as seen from its foot: arms to the right and left, and the foot.
void expect_rules_of_a_tee(const Network& network, const std::string& right_in, const std::string& right_out,
                           const std::string& left_in, const std::string& left_out,
                           const std::string& foot_in, const std::string& foot_out) {
  const Turn left{foot_in, left_out};
  const Turn right{foot_in, right_out};
  const Turn main_left{right_in, foot_out};
  EXPECT_EQ(rule_between(network, left, {right_in, left_out}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, left, {left_in, right_out}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, left, main_left), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, right, {left_in, right_out}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, right, {right_in, left_out}), std::nullopt);
  EXPECT_EQ(rule_between(network, main_left, {left_in, right_out}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, main_left, {left_in, foot_out}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, {left_in, right_out}, {right_in, left_out}), std::nullopt);
}

// NET-002 Every shape of T owes the same: drawn plainly, with strange edge names, and without lanes inside,
// where ways and their order come from connections and requests alone.
TEST(ForeignNetworks, ATeeIsATee) {
  expect_rules_of_a_tee(foreign("tee").network, "e_in", "e_out", "w_in", "w_out", "s_in", "s_out");
  expect_rules_of_a_tee(foreign("no_inner_lanes").network, "e_in", "e_out", "w_in", "w_out", "s_in", "s_out");
  expect_rules_of_a_tee(foreign("strange_names").network, "-12#3", "12#3", "gneE:4", "-gneE:4", "Straße_0",
                        "a+b.1_0");
}

// NET-002 All have a stop sign, or nobody has any sign: whoever comes first, opposing left turns too.
TEST(ForeignNetworks, AllWayStopAndUnregulatedAreFirstCome) {
  for (const char* name : {"all_way_stop", "unregulated"}) {
    const Network network = foreign(name).network;
    ASSERT_FALSE(network.conflicts.empty()) << name;
    for (const Conflict& each : network.conflicts) {
      EXPECT_EQ(each.rule, Rule::kFirstCome) << name;
    }
    EXPECT_EQ(rule_between(network, {"s_in", "n_out"}, {"e_in", "w_out"}), Rule::kFirstCome) << name;
  }
}

// NET-002 The car from the south owes the one from its right (east), is owed by the one from its left (west),
// and turning left owes the one from opposite.
TEST(ForeignNetworks, RightBeforeLeft) {
  const Network network = foreign("right_before_left").network;
  EXPECT_EQ(rule_between(network, {"s_in", "n_out"}, {"e_in", "w_out"}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, {"s_in", "n_out"}, {"w_in", "e_out"}), Rule::kFirstHasPriority);
  EXPECT_EQ(rule_between(network, {"s_in", "w_out"}, {"n_in", "s_out"}), Rule::kFirstYields);
  EXPECT_EQ(rule_between(network, {"e_in", "w_out"}, {"n_in", "s_out"}), Rule::kFirstYields);
}

// NET-002 Of a zipper's two lanes neither has the right of way.
TEST(ForeignNetworks, AZipperIsFirstCome) {
  const scenario::Scenario scenario = foreign("zipper");
  ASSERT_FALSE(scenario.network.conflicts.empty());
  for (const Conflict& each : scenario.network.conflicts) {
    EXPECT_EQ(each.rule, Rule::kFirstCome);
  }
}

// NET-002 Into a roundabout one yields to the ring; who drives on in the ring does not stop.
TEST(ForeignNetworks, TheRingHasPriority) {
  const scenario::Scenario scenario = foreign("roundabout", "over");
  EXPECT_EQ(rule_between(scenario.network, {"s_in", "ring_s"}, {"ring_w", "ring_s"}), Rule::kFirstYields);
  EXPECT_EQ(scenario.mission.edges, (std::vector<std::string>{"s_in", "ring_s", "ring_e", "n_out"}));
  EXPECT_TRUE(stops_before(scenario, "s_in_0"));
  EXPECT_FALSE(stops_before(scenario, "ring_s_0"));
}

// NET-002 Stop signs, and signals that are not obeyed: the more important road goes first, straight on or
// turning.
TEST(ForeignNetworks, SignsAndSignalsFollowThePriorities) {
  for (const char* name : {"stop_signs", "signals"}) {
    const scenario::Scenario scenario = foreign(name);
    const Turn ego{"s_in", "w_out"};
    EXPECT_EQ(rule_between(scenario.network, ego, {"e_in", "w_out"}), Rule::kFirstYields) << name;
    EXPECT_EQ(rule_between(scenario.network, ego, {"w_in", "e_out"}), Rule::kFirstYields) << name;
    EXPECT_TRUE(stops_before(scenario, "s_in_0")) << name;
  }
}

// NET-002 At right angles two ways 1.6 m from their roads' middles cross (1.6 + 7.2) = 8.8 m along each;
// boxes of 5 x 1.8 m with 0.1 m around touch within 3.6 m of it: 5.2 .. 12.4, sampled every 0.25 m.
TEST(ForeignNetworks, ZonesAreWhereBoxesTouch) {
  const Network network = foreign("all_way_stop").network;
  const LaneId mine = inside(network, {"s_in", "n_out"}).at(0);
  const LaneId other = inside(network, {"e_in", "w_out"}).at(0);
  const auto found = std::find_if(network.conflicts.begin(), network.conflicts.end(), [&](const Conflict& c) {
    return std::minmax(c.first, c.second) == std::minmax(mine, other);
  });
  ASSERT_NE(found, network.conflicts.end());
  const bool first = found->first == mine;
  EXPECT_NEAR(first ? found->first_entry_m : found->second_entry_m, 5.2, 0.3);
  EXPECT_NEAR(first ? found->first_exit_m : found->second_exit_m, 12.4, 0.3);
}

/// A lane inside a junction as SUMO's cars drive it: as drawn, from the lane before it to the one behind it.
struct DrawnWay {
  Polyline line;
  double start_m = 0.0;  ///< of the lane on it

  DrawnWay(const Network& network, LaneId lane) {
    const auto at = [&](LaneId id) -> const Lane& { return network.lanes[static_cast<std::size_t>(id)]; };
    std::vector<Vec2> points = at(at(lane).predecessors.at(0)).drawn.points();
    start_m = Polyline(points).length_m();
    for (const LaneId next : {lane, at(lane).successors.at(0)}) {
      points.insert(points.end(), at(next).drawn.points().begin(), at(next).drawn.points().end());
    }
    line = Polyline(points);
  }
  /// With its front on the line, headed away from where its rear should be.
  [[nodiscard]] traffic::Box car_at(double centre_m) const {
    const Vec2 front = line.at(start_m + centre_m + 2.5).point;
    const Vec2 rear = line.at(start_m + centre_m - 2.5).point;
    const double heading_rad = std::atan2(front.y - rear.y, front.x - rear.x);
    return {{front.x - 2.5 * std::cos(heading_rad), front.y - 2.5 * std::sin(heading_rad)},
            heading_rad,
            5.0,
            1.8};
  }
};

// NET-002 We follow the arcs that turns are rounded to, SUMO's cars the corners that the network draws, with both ends on them: wherever
// a car of theirs on one lane inside a junction and one of ours on another touch, our place is in the zone of the two.
TEST(ForeignNetworks, WhoCutsACornerIsInTheZone) {
  int touches = 0;
  for (const std::string name : {"tee", "skewed", "stop_signs", "roundabout", "four_lanes"}) {
    const Network network = foreign(name).network;
    const auto at = [&](LaneId id) -> const Lane& { return network.lanes[static_cast<std::size_t>(id)]; };
    for (const Conflict& each : network.conflicts) {
      for (const bool first_ours : {true, false}) {
        const LaneId ours = first_ours ? each.first : each.second;
        const LaneId theirs = first_ours ? each.second : each.first;
        if (!at(ours).in_junction || !at(theirs).in_junction) {
          continue;
        }
        const double entry_m = first_ours ? each.first_entry_m : each.second_entry_m;
        const double exit_m = first_ours ? each.first_exit_m : each.second_exit_m;
        const DrawnWay way(network, theirs);
        for (double other_m = 0.0; other_m < at(theirs).drawn.length_m(); other_m += 0.25) {
          const traffic::Box car = way.car_at(other_m);
          for (double own_m = 0.0; own_m < at(ours).centre.length_m(); own_m += 0.25) {
            const PolylinePose pose = at(ours).centre.at(own_m);
            if (!traffic::overlap({pose.point, pose.heading_rad, 5.0, 1.8}, car)) {
              continue;
            }
            ++touches;
            EXPECT_GT(own_m, entry_m - 0.3)
                << name << ' ' << at(ours).name << ' ' << at(theirs).name << ' ' << other_m;
            EXPECT_LT(own_m, exit_m + 0.3)
                << name << ' ' << at(ours).name << ' ' << at(theirs).name << ' ' << other_m;
          }
        }
      }
    }
  }
  EXPECT_GT(touches, 1000);
}

// Turned by any angle and moved as far as UTM coordinates lie, a cross has the zones it has at home.
TEST(ForeignNetworks, PlaceAndTurnDoNotMatter) {
  const Network far = foreign("far_away").network;
  const Network near = foreign("stop_signs").network;  // the same cross
  ASSERT_EQ(far.conflicts.size(), near.conflicts.size());
  EXPECT_EQ(rule_between(far, {"s_in", "w_out"}, {"e_in", "w_out"}), Rule::kFirstYields);
  EXPECT_NEAR(lane(far, "s_in_0").centre.length_m(), lane(near, "s_in_0").centre.length_m(), 0.05);
}

// NET-003 The right lane is wanted less than 50 m after one has come into the left one of three: two changes.
TEST(ForeignNetworks, LateChangesAreKnown) {
  const scenario::Scenario scenario = foreign("late_changes");
  const LaneId entered = scenario.network.find("w_in_2");
  EXPECT_EQ(scenario::mission_guide(scenario).advice(entered).changes_needed, -2);
  EXPECT_LT(lane(scenario.network, "w_in_2").centre.length_m(), 50.0);
  EXPECT_EQ(scenario::mission_guide(foreign("late_changes", "left")).advice(entered).changes_needed, 0);
}

// SCN-002 A shoulder that cars may not use is no lane: SUMO's lane 1 is the rightmost one; the mission keeps
// its lane.
TEST(ForeignNetworks, AShoulderIsNoLane) {
  const scenario::Scenario scenario = foreign("curve", "change");
  EXPECT_EQ(scenario.network.find("bend_0"), kNoLane);
  EXPECT_EQ(scenario.mission.start_lane, scenario.network.lane_of("bend", 1));
  EXPECT_EQ(lane(scenario.network, "bend_1").right, kNoLane);
  EXPECT_EQ(scenario::mission_guide(scenario).advice(scenario.mission.start_lane).changes_needed, 1);
}

// A right turn as netconvert draws it, with five points, turns over 40 degrees in its middle two metres; a
// car follows the arc of 5.6 m between its lanes (1/5.6 = 0.18 1/m; ours can do 0.21).
TEST(ForeignNetworks, RightTurnsAreArcs) {
  const Network network = foreign("tee").network;
  const Polyline& turn =
      network.lanes[static_cast<std::size_t>(inside(network, {"s_in", "e_out"}).at(0))].centre;
  for (double s = 0.5; s < turn.length_m() - 0.5; s += 0.25) {
    EXPECT_NEAR(std::abs(turn.at(s).curvature_1pm), 1.0 / 5.6, 0.02) << s;
  }
}

// Four lanes, the turn only from the rightmost: from the third one two changes to the right.
TEST(ForeignNetworks, FourLanesToTheRightTurn) {
  const scenario::Scenario scenario = foreign("four_lanes", "right");
  EXPECT_EQ(scenario::mission_guide(scenario).advice(scenario.network.find("w_in_2")).changes_needed, -2);
}

class ForeignMaps : public testing::TestWithParam<std::string> {};

// MAP-002 For every network and mission: what the map node shows fits the bus, lies around the ego, holds the
// whole route, and every zone lies on its lanes.
TEST_P(ForeignMaps, AreShownRight) {
  const scenario::Scenario scenario = foreign(GetParam());
  const Polyline& start =
      scenario.network.lanes[static_cast<std::size_t>(scenario.mission.start_lane)].centre;
  const Vec2 origin = start.at(scenario.mission.start_s_m).point;
  const RouteGuide guide = scenario::mission_guide(scenario);
  nodes::MapNode node(scenario.network, guide, origin);
  const wire::Map& map = node.update(origin);
  EXPECT_EQ(map.lanes_left_out, 0);
  int on_route = 0;
  for (const wire::Lane& shown : map.lanes) {
    for (int i = 0; shown.present && i < shown.point_count; ++i) {
      EXPECT_LT(std::hypot(shown.x_m[i], shown.y_m[i]), 400.0F);
    }
    on_route += shown.present && shown.on_route ? 1 : 0;
    EXPECT_FALSE(shown.present && shown.on_route && shown.kind != 0) << "the route is ours";
  }
  EXPECT_GT(on_route, 0);
  for (const wire::Conflict& conflict : map.conflicts) {
    if (conflict.present) {
      ASSERT_LT(conflict.first, wire::kMaxLanes);
      ASSERT_LT(conflict.second, wire::kMaxLanes);
      EXPECT_LE(conflict.first_entry_m, conflict.first_exit_m);
      EXPECT_LE(conflict.second_entry_m, conflict.second_exit_m);
    }
  }
  for (const Lane& each : scenario.network.lanes) {  // lanes join: no gaps where ways go on
    for (const LaneId next : each.successors) {
      const Vec2 a = each.centre.points().back();
      const Vec2 b = scenario.network.lanes[static_cast<std::size_t>(next)].centre.points().front();
      EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 0.2) << each.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ForeignMaps,
                         testing::Values("skewed", "all_way_stop", "right_before_left", "zipper",
                                         "roundabout", "tee", "four_lanes", "short_ramp", "curve",
                                         "late_changes", "far_away", "strange_names", "no_inner_lanes",
                                         "unregulated", "stop_signs", "signals", "sharp_fast"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace s4tp::map
