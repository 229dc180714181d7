/// Roads without a junction: bends, and the cruise, overtake and cut-in of the shipped scenarios.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "sim_host/roads/draws.hpp"

namespace s4tp::roads {
namespace {

using traffic::Random;

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr const char* kRoad = "road";

/// Appends an arc, in pieces of at most 2 m, that goes on where the shape ends.
void bend(std::vector<map::Vec2>& shape, double& heading_rad, double radius_m, double turn_rad) {
  const int pieces = std::max(1, static_cast<int>(std::ceil(radius_m * std::abs(turn_rad) / 2.0)));
  const double step_rad = turn_rad / pieces;
  const double chord_m = 2.0 * radius_m * std::sin(0.5 * std::abs(step_rad));
  for (int i = 0; i < pieces; ++i) {
    const double along_rad = heading_rad + 0.5 * step_rad;
    const map::Vec2 from = shape.back();
    shape.push_back({from.x + chord_m * std::cos(along_rad), from.y + chord_m * std::sin(along_rad)});
    heading_rad += step_rad;
  }
}

void straight(std::vector<map::Vec2>& shape, double heading_rad, double length_m) {
  const map::Vec2 from = shape.back();
  shape.push_back({from.x + length_m * std::cos(heading_rad), from.y + length_m * std::sin(heading_rad)});
}

PlainNetwork one_edge(const std::vector<map::Vec2>& shape, int lanes, double speed_mps) {
  PlainNetwork network;
  network.nodes = {{"a", shape.front()}, {"b", shape.back()}};
  PlainEdge edge{kRoad, "a", "b", lanes, speed_mps};
  edge.shape = shape;
  network.edges = {edge};
  return network;
}

RoadMission along(Random& random, int start_lane, int goal_lane) {
  RoadMission mission = draw_mission(random);
  mission.start_edge = mission.goal_edge = kRoad;
  mission.start_lane = start_lane;
  mission.goal_lane = goal_lane;
  return mission;
}

/// 150 to 350 m, straight or in a wide bend.
PlainNetwork draw_open_road(Random& random, int lanes) {
  constexpr double kRunIn_m = 30.0;
  const double length_m = random.uniform(150.0, 350.0);
  const double speed_mps = one_of<double>({11.11, 13.89, 16.67, 22.22}, random);
  std::vector<map::Vec2> shape{{}};
  double heading_rad = 0.0;
  if (random.integer(0, 1) == 0) {
    straight(shape, heading_rad, length_m);
  } else {
    const double radius_m = random.uniform(200.0, 600.0);
    const double side = random.integer(0, 1) == 0 ? -1.0 : 1.0;
    straight(shape, heading_rad, kRunIn_m);
    bend(shape, heading_rad, radius_m, side * (length_m - kRunIn_m) / radius_m);
  }
  return one_edge(shape, lanes, speed_mps);
}

/// A stream in each of the lanes given.
Streams in_lanes(const std::vector<int>& lanes, scenario::Range vehicles_per_minute) {
  Streams streams;
  for (const int lane : lanes) {
    streams.ways.push_back({{kRoad}, lane, -1});
  }
  streams.vehicles_per_minute = vehicles_per_minute;
  return streams;
}

std::vector<int> lanes_but(int lanes, int left_out) {
  std::vector<int> others;
  for (int lane = 0; lane < lanes; ++lane) {
    if (lane != left_out) {
      others.push_back(lane);
    }
  }
  return others;
}

}  // namespace

/// A run-in, a bend, now and then one back. At the limit a bend takes at most 4 m/s^2 to the side, as nobody
/// would sign it faster.
Road draw_curve(Random& random) {
  constexpr double kSideways_mps2 = 4.0;
  const int lanes = random.integer(1, 4);
  const double speed_mps = one_of<double>({8.33, 11.11, 13.89}, random);
  const double inside_m = lanes * kLaneWidth_m;
  const double least_m = std::max(speed_mps * speed_mps / kSideways_mps2, 10.0) + inside_m;
  const double side = random.integer(0, 1) == 0 ? -1.0 : 1.0;
  std::vector<map::Vec2> shape{{}};
  double heading_rad = 0.0;
  straight(shape, heading_rad, random.uniform(20.0, 60.0));
  const double radius_m = draw_length_m(random, least_m, least_m + 80.0);
  const double turn_rad = random.uniform(40.0, 150.0) * kDegree_rad;
  bend(shape, heading_rad, radius_m, side * turn_rad);
  if (random.integer(0, 1) == 0) {
    bend(shape, heading_rad, draw_length_m(random, least_m, least_m + 80.0), -side * turn_rad);
  }
  straight(shape, heading_rad, random.uniform(20.0, 60.0));
  Road road;
  road.network = one_edge(shape, lanes, speed_mps);
  const int start_lane = random.integer(0, lanes - 1);
  const int goal_lane = random.integer(0, lanes - 1);
  road.mission = along(random, start_lane, goal_lane);
  road.smarts.streams = {in_lanes(lanes_but(lanes, -1), draw_rate(random))};
  road.social = with_social_drivers(road.smarts);
  return road;
}

Road draw_cruise(Random& random) {
  const int lanes = random.integer(1, 5);
  Road road;
  road.network = draw_open_road(random, lanes);
  const int lane = random.integer(0, lanes - 1);
  road.mission = along(random, lane, lane);
  road.smarts.streams = {in_lanes(lanes_but(lanes, -1), draw_rate(random))};
  road.social = with_social_drivers(road.smarts);
  road.smarts.driver = "lane_keeping = true";
  return road;
}

/// Slow drivers in the ego's lane, nobody in the others; `social` has some in the others, too.
Road draw_overtake(Random& random) {
  const int lanes = random.integer(2, 4);
  Road road;
  road.network = draw_open_road(random, lanes);
  const int lane = random.integer(0, lanes - 1);
  road.mission = along(random, lane, lane);
  Streams slow = in_lanes({lane}, draw_rate(random));
  slow.driver = "max_speed_mps = 10.0, min_gap_mean_m = 4.0, min_gap_deviation_m = 1.2, lane_keeping = true";
  road.smarts.streams = {slow};
  slow.driver = "max_speed_mps = 6.0, min_gap_mean_m = 4.0, min_gap_deviation_m = 1.2, lane_keeping = true";
  Streams others = in_lanes(lanes_but(lanes, lane), draw_rate(random, 12.0));
  others.driver = "speed_factor_mean = 0.85";
  road.social = with_social_drivers({{}, {}, {slow, others}});
  return road;
}

/// Drivers on either side change into and across the ego's lane with short gaps.
Road draw_cut_in(Random& random) {
  const int lanes = random.integer(2, 5);
  Road road;
  road.network = draw_open_road(random, lanes);
  const int lane = random.integer(0, lanes - 1);
  road.mission = along(random, lane, lane);
  Streams streams;
  for (const int from : lanes_but(lanes, lane)) {
    if (std::abs(from - lane) == 1) {
      streams.ways.push_back({{kRoad}, from, lane});
      const int across = 2 * lane - from;
      if (across >= 0 && across < lanes) {
        streams.ways.push_back({{kRoad}, from, across});
      }
    }
  }
  streams.choose_low = 1;
  streams.choose_high = static_cast<int>(streams.ways.size());
  streams.vehicles_per_minute = draw_rate(random);
  road.smarts = {"headway_s = 0.6, min_gap_mean_m = 1.5, speed_factor_mean = 1.1", {}, {streams}};
  road.social = {"headway_s = 0.8, min_gap_mean_m = 2.0, speed_factor_mean = 1.1",
                 R"([
  { name = "competitive", weight = 0.5, svo_rad = -0.2 },
  { name = "individual", weight = 0.3, svo_rad = 0.0 },
  { name = "considerate", weight = 0.2, svo_rad = 0.2 },
])",
                 {streams}};
  return road;
}

}  // namespace s4tp::roads
