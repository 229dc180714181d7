// Roads by number (needs netconvert, Debian package sumo): what every one keeps, and what some hundred of
// them cover together.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "sim_host/roads/generator.hpp"
#include "sim_host/roads/road.hpp"
#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"
#include "sim_host/world/traffic/traffic_flow.hpp"
#include "tests/support/content.hpp"
#include "tests/support/networks.hpp"

namespace s4tp::roads {
namespace {

namespace fs = std::filesystem;
using map::Lane;
using map::Network;
using scenario::Scenario;

const fs::path kMix = fs::path(S4TP_SOURCE_DIR) / "sim_host/scenarios/social.toml";

const Lane& lane_at(const Scenario& road, map::LaneId lane) {
  return road.network.lanes.at(static_cast<std::size_t>(lane));
}

/// Smallest and largest of what was seen.
struct Seen {
  double low = 1e9;
  double high = -1e9;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] bool covers(double from, double to) const { return low <= from && high >= to; }
};

/// By what name, and in which family's roads.
using Coverage = std::map<std::string, std::map<std::string, Seen>>;

double turned_deg(const Scenario& road) {
  const Lane& start = lane_at(road, road.mission.start_lane);
  const Lane& goal = lane_at(road, road.mission.goal_lane);
  const double turn_rad =
      goal.centre.at(0.0).heading_rad - start.centre.at(start.centre.length_m()).heading_rad;
  return std::remainder(turn_rad, 2.0 * std::numbers::pi) * 180.0 / std::numbers::pi;
}

void add_to(Coverage& coverage, const std::string& family, const Scenario& road) {
  const auto see = [&](const char* what, double value) { coverage[what][family].add(value); };
  const Lane& start = lane_at(road, road.mission.start_lane);
  const Lane& goal = lane_at(road, road.mission.goal_lane);
  see("start lane, m", start.centre.length_m());
  see("goal lane, m", goal.centre.length_m());
  see("lanes beside the start", static_cast<double>(road.network.lanes_of(start.edge).size()));
  see("lanes beside the goal", static_cast<double>(road.network.lanes_of(goal.edge).size()));
  see("limit, m/s", start.speed_limit_mps);
  see("entry, m/s", road.mission.start_speed_mps);
  see("turned, degrees", turned_deg(road));
  for (const scenario::FlowGroup& group : road.flows) {
    see("vehicles a minute and stream", group.vehicles_per_minute.low);
    see("vehicles a minute and stream", group.vehicles_per_minute.high);
    see("streams", group.choose_high);
  }
  if (family == "ramp_lane") {
    const auto beside = road.network.lanes_of("beside");
    see("acceleration lane, m", lane_at(road, beside.front()).centre.length_m());
  }
}

void print(const Coverage& coverage) {
  for (const auto& [what, families] : coverage) {
    std::printf("%s\n", what.c_str());
    for (const auto& [family, seen] : families) {
      std::printf("  %-20s%8.1f to%8.1f\n", family.c_str(), seen.low, seen.high);
    }
  }
}

Seen all_of(const Coverage& coverage, const std::string& what) {
  Seen all;
  for (const auto& [family, seen] : coverage.at(what)) {
    all.add(seen.low);
    all.add(seen.high);
  }
  return all;
}

// ROAD-001, ROAD-002 Numbers 0 to 139, ten of each family, and to 279 of the two whose ends are rare: each loads
// in both flavours, has a way, and traffic of 5 to 20 vehicles a minute and lane. Together they come near the
// ends of the ranges: arms from 25 m (netconvert may round half a metre off), 1 to 4 lanes, turns of many
// angles, every rule of way, acceleration lanes of 40 to 200 m (their outer eighths: twenty roads miss one of
// them in 2 * 0.875^20 = 14 % of all blocks of numbers) into 1 to 5 lanes.
TEST(Roads, CoverWhatTheyShould) {
  const test::Folder out;
  Coverage coverage;
  std::set<std::string> rules;
  int thrown_away = 0;
  for (std::uint64_t number = 0; number < 280; ++number) {
    const std::string family = families()[number % families().size()].name;
    if (number >= 140 && family != "crossing_straight" && family != "ramp_lane") continue;
    const WrittenRoad written = write_road(number, kMix, out.path());
    SCOPED_TRACE(written.folder.filename().string());
    for (const auto& [reason, times] : written.refused) thrown_away += times;
    EXPECT_EQ(written.family, family);
    EXPECT_EQ(family_of(written.folder.filename().string()), written.family);
    for (const std::string flavour : {"smarts", "social"}) {
      const Scenario road = scenario::load_scenario(written.folder, flavour);
      EXPECT_FALSE(road.mission.edges.empty());
      EXPECT_EQ(road.mission.time_limit_s, 80.0);
      EXPECT_GE(lane_at(road, road.mission.start_lane).centre.length_m(), 24.5);
      EXPECT_GE(lane_at(road, road.mission.goal_lane).centre.length_m(), 24.5);
      for (const scenario::FlowGroup& group : road.flows) {
        EXPECT_GE(group.vehicles_per_minute.low, 5.0);
        EXPECT_LE(group.vehicles_per_minute.high, 20.0);
      }
      traffic::Random random(number);
      const traffic::FlowPlan plan = traffic::draw_flows(road.network, road.flows, 60.0, random);
      EXPECT_FALSE(plan.departures.empty());
      if (flavour == "smarts") add_to(coverage, written.family, road);
    }
    const std::string network = test::content(written.folder / "network.net.xml");
    for (const char* rule : {"priority", "priority_stop", "allway_stop", "right_before_left", "zipper"}) {
      if (network.find("type=\"" + std::string(rule) + '"') != std::string::npos) rules.insert(rule);
    }
  }
  print(coverage);
  std::printf("160 roads, %d draws thrown away\n", thrown_away);
  EXPECT_EQ(rules.size(), 5U);
  EXPECT_TRUE(all_of(coverage, "start lane, m").covers(27.0, 140.0));
  EXPECT_TRUE(all_of(coverage, "goal lane, m").covers(27.0, 140.0));
  EXPECT_TRUE(all_of(coverage, "vehicles a minute and stream").covers(5.5, 19.5));
  Seen lanes_in;
  Seen lanes_out;
  for (const char* family :
       {"crossing_left", "crossing_straight", "crossing_right", "tee_left", "tee_right"}) {
    lanes_in.add(coverage["lanes beside the start"][family].high);
    lanes_out.add(coverage["lanes beside the goal"][family].high);
    EXPECT_EQ(coverage["lanes beside the start"][family].low, 1.0) << family;
    EXPECT_EQ(coverage["lanes beside the goal"][family].low, 1.0) << family;
  }
  EXPECT_EQ(lanes_in.high, 4.0);
  EXPECT_EQ(lanes_out.high, 4.0);
  EXPECT_TRUE(coverage["turned, degrees"]["crossing_left"].covers(50.0, 115.0));
  EXPECT_TRUE(coverage["turned, degrees"]["crossing_straight"].covers(-25.0, 25.0));
  EXPECT_TRUE(coverage["turned, degrees"]["crossing_right"].covers(-105.0, -50.0));
  EXPECT_TRUE(coverage["acceleration lane, m"]["ramp_lane"].covers(60.0, 180.0));
  EXPECT_TRUE(coverage["lanes beside the goal"]["ramp_lane"].covers(1.0, 5.0));
  EXPECT_TRUE(coverage["lanes beside the goal"]["ramp_junction"].covers(1.0, 4.0));
}

// ROAD-001 The same number gives the same bytes, whatever was drawn before it.
TEST(Roads, AreAFunctionOfTheirNumber) {
  const test::Folder first;
  const test::Folder second;
  std::vector<WrittenRoad> written;
  for (std::uint64_t number = 300; number < 314; ++number) {
    written.push_back(write_road(number, kMix, first.path()));
  }
  for (std::uint64_t number = 314; number-- > 300;) {
    const WrittenRoad again = write_road(number, kMix, second.path());
    const WrittenRoad& before = written[number - 300];
    EXPECT_EQ(again.refused, before.refused);
    for (const char* file : {"network.net.xml", "scenario.toml", "social.toml"}) {
      EXPECT_FALSE(test::content(again.folder / file).empty()) << file;
      EXPECT_EQ(test::content(again.folder / file), test::content(before.folder / file))
          << before.folder << file;
    }
  }
}

// A ramp that ends in a junction leads into a lane that others drive in, and yields to them there.
TEST(Roads, RampsThatEndInAJunctionMergeIntoAnOccupiedLane) {
  const test::Folder out;
  for (std::uint64_t number = 7; number < 140; number += families().size()) {
    const WrittenRoad written = write_road(number, kMix, out.path());
    ASSERT_EQ(written.family, "ramp_junction");
    const Network network = scenario::load_scenario(written.folder).network;
    const map::LaneId from_ramp = test::lane(network, "ramp_0").successors.at(0);
    const map::LaneId from_main = test::lane(network, "main_0").successors.at(0);
    EXPECT_EQ(network.lanes[static_cast<std::size_t>(from_ramp)].successors,
              network.lanes[static_cast<std::size_t>(from_main)].successors);
    const auto yields = [&](const map::Conflict& conflict) {
      return (conflict.first == from_ramp && conflict.second == from_main &&
              conflict.rule == map::Rule::kFirstYields) ||
             (conflict.first == from_main && conflict.second == from_ramp &&
              conflict.rule == map::Rule::kFirstHasPriority);
    };
    EXPECT_TRUE(std::any_of(network.conflicts.begin(), network.conflicts.end(), yields)) << written.folder;
  }
}

// Where a lane change is due before the turn and one after it, the way from the start lane without a change
// does not lead on, and the lanes that turn do not lead into the goal lane.
TEST(Roads, LateChangesAreDueBeforeAndAfterTheTurn) {
  const test::Folder out;
  for (std::uint64_t number = 5; number < 140; number += families().size()) {
    const WrittenRoad written = write_road(number, kMix, out.path());
    ASSERT_EQ(written.family, "late_change");
    const Scenario road = scenario::load_scenario(written.folder);
    const map::RouteGuide guide(road.network, road.mission.edges, road.mission.goal_lane,
                                road.mission.goal_s_m);
    const auto& at_start = guide.advice(road.mission.start_lane);
    EXPECT_NE(at_start.changes_needed, 0);
    EXPECT_EQ(at_start.next, map::kNoLane);
    EXPECT_TRUE(std::all_of(lane_at(road, road.mission.goal_lane).predecessors.begin(),
                            lane_at(road, road.mission.goal_lane).predecessors.end(),
                            [&](map::LaneId before) { return !guide.advice(before).on_route; }));
  }
}

// SUMO takes the networks and the streams as they are: after 30 s cars drive on one road of each family.
TEST(Roads, AreDrivenOnInSumo) {
  const test::Folder out;
  for (std::uint64_t number = 0; number < families().size(); ++number) {
    const WrittenRoad written = write_road(number, kMix, out.path());
    for (const std::string flavour : {"smarts", "social"}) {
      const Scenario road = scenario::load_scenario(written.folder, flavour);
      const auto traffic = world::make_engine(road, {scenario::Engine::kSumo, 1, 1, traffic::DrivenBy::kUs});
      std::size_t most = 0;
      for (int tick = 0; tick < 3000; ++tick) {
        traffic->step(nullptr);
        most = std::max(most, traffic->cars().size());
      }
      EXPECT_GT(most, 0U) << written.folder << ' ' << flavour;
    }
  }
}

}  // namespace
}  // namespace s4tp::roads
