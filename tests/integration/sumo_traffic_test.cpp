// These need Debian's sumo and fail without it.
#include "sim_host/sumo/sumo_traffic.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/traffic/box.hpp"
#include "sim_host/world/world.hpp"
#include "tests/support/sumo_scenarios.hpp"

namespace s4tp::sumo {
namespace {

using map::LaneId;
using scenario::Scenario;

namespace fs = std::filesystem;
using namespace std::chrono_literals;

traffic::EgoSeen standing_at(const Scenario& scenario, LaneId lane, double s_m) {
  const map::PolylinePose pose = scenario.network.lanes[static_cast<std::size_t>(lane)].centre.at(s_m);
  traffic::EgoSeen ego;
  ego.car.centre = pose.point;
  ego.car.heading_rad = pose.heading_rad;
  return ego;
}

/// From the mission's start through the junction: the lanes of the way that ends on the goal's edge.
std::vector<LaneId> way_through(const Scenario& scenario) {
  const auto lane_of = [&](LaneId id) { return scenario.network.lanes[static_cast<std::size_t>(id)]; };
  for (const LaneId turn : lane_of(scenario.mission.start_lane).successors) {
    std::vector<LaneId> way{scenario.mission.start_lane, turn};
    while (lane_of(way.back()).in_junction) way.push_back(lane_of(way.back()).successors.front());
    if (lane_of(way.back()).edge == lane_of(scenario.mission.goal_lane).edge) return way;
  }
  return {};
}

// WORLD-040 One seed, the same cars to the bit; another seed, others.
TEST(SumoTraffic, IsDeterministicInItsSeed) {
  const Scenario scenario = shipped("left_turn");
  Traffic one(scenario, without_ego(11));
  Traffic again(scenario, without_ego(11));
  Traffic other(scenario, without_ego(12));
  bool differs = false;
  for (int i = 0; i < 2500; ++i) {
    one.step(nullptr);
    again.step(nullptr);
    other.step(nullptr);
    ASSERT_TRUE(same(one.cars(), again.cars())) << i;
    differs = differs || !same(one.cars(), other.cars());
  }
  EXPECT_TRUE(differs);
  EXPECT_GT(one.finished(), 0);
}

// SUMO-002 On an empty straight road drivers who want 10 m/s at most drive as our plan drew them: never
// faster.
TEST(SumoTraffic, DrivesThePlansDrivers) {
  Traffic traffic(shipped("overtake"), without_ego(4));
  std::size_t most = 0;
  while (traffic.time_s() < 20.0) {
    traffic.step(nullptr);
    most = std::max(most, traffic.cars().size());
    for (const traffic::CarState& car : traffic.cars()) EXPECT_LE(car.speed_mps, 10.0 + 1e-9);
  }
  EXPECT_GE(most, 2U);
}

// SUMO says the lane of the front bumper, we that of the box centre: it lies within that lane.
TEST(SumoTraffic, SaysTheLaneOfTheCentre) {
  const Scenario scenario = shipped("left_turn");
  Traffic traffic(scenario, without_ego(3));
  int in_junction = 0;
  while (traffic.time_s() < 40.0 - 1e-6) {
    advance(traffic, traffic.time_s() + 0.1);
    for (const traffic::CarState& car : traffic.cars()) {
      ASSERT_NE(car.lane, map::kNoLane);
      const map::Lane& lane = scenario.network.lanes[static_cast<std::size_t>(car.lane)];
      const double s_m = lane.centre.project(car.centre).s_m;
      EXPECT_GE(s_m, -0.01) << lane.name << " at " << traffic.time_s() << " s";
      EXPECT_LE(s_m, lane.centre.length_m() + 0.5) << lane.name << " at " << traffic.time_s() << " s";
      in_junction += lane.in_junction ? 1 : 0;
    }
  }
  EXPECT_GT(in_junction, 20);
}

// Between two steps cars move evenly: no 10 ms step is longer than 20 m/s would make it.
TEST(SumoTraffic, MovesSmoothlyBetweenSteps) {
  Traffic traffic(shipped("merge"), without_ego(3));
  std::map<int, map::Vec2> before;
  for (int i = 0; i < 2000; ++i) {
    traffic.step(nullptr);
    for (const traffic::CarState& car : traffic.cars()) {
      if (before.count(car.id) != 0) {
        EXPECT_LT(std::hypot(car.centre.x - before[car.id].x, car.centre.y - before[car.id].y), 0.2);
      }
      before[car.id] = car.centre;
    }
  }
  EXPECT_FALSE(before.empty());
}

// Whoever comes along behind a standing ego stops: boxes never touch, and somebody does come to a stand.
TEST(SumoTraffic, StopsBehindAStandingEgo) {
  const Scenario scenario = shipped("overtake");
  traffic::EngineOptions options = without_ego(4);
  options.ego = traffic::DrivenBy::kUs;
  Traffic traffic(scenario, options, {.early = false});
  const traffic::EgoSeen ego = standing_at(scenario, scenario.mission.start_lane, 120.0);
  bool stood = false;
  while (traffic.time_s() < 40.0) {
    traffic.step(&ego);
    for (const traffic::CarState& car : traffic.cars())
      EXPECT_FALSE(traffic::overlap(traffic::box_of(ego.car), traffic::box_of(car)));
    for (const traffic::CarFlags& flags : traffic.flags()) stood = stood || flags.waiting;
  }
  EXPECT_TRUE(stood);
}

// SUMO has the ego where we said, to a millimetre: 13 m/s, turning with 0.1 rad/s, told 0.1 s ahead.
TEST(SumoTraffic, PlacesTheEgoAtTheStepsEnd) {
  const Scenario scenario = shipped("cruise");
  traffic::EngineOptions options = without_ego(4);
  options.ego = traffic::DrivenBy::kUs;
  Traffic traffic(scenario, options, {.early = false});
  traffic::EgoSeen ego = standing_at(scenario, scenario.mission.start_lane, 20.0);
  ego.car.speed_mps = 13.0;
  for (int i = 0; i < 30; ++i) {
    traffic.step(&ego);
    ego.car.centre.x += 0.13;  // the road leads east
  }
  const traffic::CarState seen = traffic.ego_seen().value();
  EXPECT_NEAR(seen.centre.x, ego.car.centre.x, 1e-3);
  EXPECT_NEAR(seen.centre.y, ego.car.centre.y, 1e-3);
  EXPECT_NEAR(seen.speed_mps, 13.0, 1e-6);
}

// Half a metre beside the centre of our left turn, where six other ways cross it: SUMO has us on our route's
// lanes all the way. Without on_route it takes the nearest lane, and that is another one on the way.
TEST(SumoTraffic, KeepsTheEgoOnItsRoute) {
  const Scenario scenario = shipped("left_turn");
  const std::vector<LaneId> way = way_through(scenario);
  ASSERT_FALSE(way.empty());
  for (const bool on_route : {true, false}) {
    traffic::EngineOptions options = without_ego(4);
    options.ego = traffic::DrivenBy::kUs;
    Traffic traffic(scenario, options, {.early = false, .on_route = on_route});
    int elsewhere = 0;
    for (const LaneId id : way) {
      const map::Polyline& centre = scenario.network.lanes[static_cast<std::size_t>(id)].centre;
      for (double s_m = 3.0; s_m < std::min(centre.length_m(), 30.0); s_m += 0.3) {
        traffic::EgoSeen ego = standing_at(scenario, id, s_m);
        ego.car.centre.x += 0.5 * std::sin(ego.car.heading_rad);
        ego.car.centre.y -= 0.5 * std::cos(ego.car.heading_rad);
        for (int i = 0; i < 20; ++i) traffic.step(&ego);
        const LaneId seen = traffic.ego_seen().value().lane;
        elsewhere += std::find(way.begin(), way.end(), seen) == way.end() ? 1 : 0;
      }
    }
    if (on_route) {
      EXPECT_EQ(elsewhere, 0);
    } else {
      EXPECT_GT(elsewhere, 0);
    }
  }
}

// An ego that has left its route is seen where it is: whoever comes along there stops behind it.
TEST(SumoTraffic, StopsBehindAnEgoOffItsRoute) {
  const Scenario scenario = shipped("left_turn");
  const LaneId oncoming = scenario.network.find("north_in_0");
  traffic::EngineOptions options = without_ego(4);
  options.ego = traffic::DrivenBy::kUs;
  Traffic traffic(scenario, options, {.early = false});
  const traffic::EgoSeen ego = standing_at(scenario, oncoming, 60.0);
  bool stood = false;
  while (traffic.time_s() < 60.0) {
    traffic.step(&ego);
    for (const traffic::CarState& car : traffic.cars()) {
      if (traffic.time_s() > 1.0) {
        EXPECT_FALSE(traffic::overlap(traffic::box_of(ego.car), traffic::box_of(car)));
      }
      stood = stood || (car.lane == oncoming && car.speed_mps < 0.1);
    }
  }
  EXPECT_TRUE(stood);
}

// Emptying a stretch takes those whose box reaches into it, for SUMO too, and nobody else.
TEST(SumoTraffic, ClearsAStretch) {
  const Scenario scenario = shipped("cruise");
  Traffic traffic(scenario, without_ego(5));
  advance(traffic, 20.0);
  const std::size_t before = traffic.cars().size();
  const int finished = traffic.finished();
  ASSERT_GT(before, 0U);
  const LaneId lane = traffic.cars().front().lane;
  traffic.clear(lane, -10.0, 210.0);
  const std::size_t after = traffic.cars().size();
  EXPECT_LT(after, before);
  for (const traffic::CarState& car : traffic.cars()) EXPECT_NE(car.lane, lane);
  traffic.step(nullptr);
  EXPECT_LE(traffic.cars().size(), after + 3);
  EXPECT_EQ(traffic.finished(), finished);
}

// A user's own route files: the episode takes its number modulo theirs; ids and types are the user's.
TEST(SumoTraffic, TakesRouteFilesByEpisode) {
  Scenario scenario = shipped("cruise");
  const fs::path folder = fs::temp_directory_path() / ("s4tp_routes_" + std::to_string(getpid()));
  fs::create_directories(folder);
  for (int i = 0; i < 2; ++i) {
    const fs::path file = folder / ("traffic-" + std::to_string(i) + ".rou.xml");
    std::ofstream(file) << "<routes><vType id=\"lorry\" length=\"" << 8 + i << "\" width=\"2.4\"/>"
                        << "<vehicle id=\"theirs:" << i << "\" type=\"lorry\" depart=\"0\" departLane=\"" << i
                        << "\"><route edges=\"" << scenario.mission.edges.front()
                        << "\"/></vehicle></routes>";
    scenario.route_files.push_back(file);
  }
  for (const std::uint64_t episode : {0U, 3U}) {
    Traffic traffic(scenario, without_ego(episode));
    advance(traffic, 2.0);
    ASSERT_EQ(traffic.cars().size(), 1U);
    EXPECT_DOUBLE_EQ(traffic.cars().front().length_m, episode == 0 ? 8.0 : 9.0);
    EXPECT_EQ(scenario.network.lanes[static_cast<std::size_t>(traffic.cars().front().lane)].index,
              episode == 0 ? 0 : 1);
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace s4tp::sumo
