/// Crossings, T junctions and roundabouts, at any angle.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "sim_host/roads/draws.hpp"

namespace s4tp::roads {
namespace {

using traffic::Random;

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kApart_rad = 45.0 * kDegree_rad;
constexpr double kLongestArm_m = 150.0;

struct Arm {
  std::string name;
  double direction_rad = 0.0;
  double length_m = 0.0;
  int lanes_in = 1;
  int lanes_out = 1;
  int priority = 1;
};

/// \param reach_m  of the junction: what it takes off the arms' lengths
PlainNetwork star(const std::vector<Arm>& arms, const std::string& type, double corner_m, double reach_m,
                  double speed_mps) {
  PlainNetwork network;
  network.nodes.push_back({"c", {}, type, corner_m});
  for (const Arm& arm : arms) {
    network.nodes.push_back({arm.name, polar(reach_m + arm.length_m, arm.direction_rad)});
    network.edges.push_back({arm.name + "_in", arm.name, "c", arm.lanes_in, speed_mps, arm.priority});
    network.edges.push_back({arm.name + "_out", "c", arm.name, arm.lanes_out, speed_mps, arm.priority});
  }
  return network;
}

double reach_of(const std::vector<Arm>& arms, double corner_m) {
  int most = 1;
  for (const Arm& arm : arms) {
    most = std::max({most, arm.lanes_in, arm.lanes_out});
  }
  return corner_m + most * kLaneWidth_m;
}

/// Whether the way from arm `from` to arm `to` crosses ours or ends in the same arm. Round the junction each
/// arm has, counterclockwise, its way out and its way in; two ways cross when their ends alternate.
bool meets(int from, int to, int start, int goal, int count) {
  const auto after_start = [&](int place) { return (place - (2 * start + 1) + 4 * count) % (2 * count); };
  const int goal_out = after_start(2 * goal);
  return to == goal || (after_start(2 * from + 1) < goal_out) != (after_start(2 * to) < goal_out);
}

/// Streams from each arm to each other one: those our way meets, those that begin in our arm, and the rest.
RoadTraffic traffic_between(const std::vector<Arm>& arms, int start, int goal, Random& random) {
  const int count = static_cast<int>(arms.size());
  Streams met = draw_crossing_streams(random);
  Streams ours;
  ours.choose_high = 1;
  ours.vehicles_per_minute = draw_rate(random);
  Streams others = ours;
  others.vehicles_per_minute = draw_rate(random);
  for (int from = 0; from < count; ++from) {
    for (int to = 0; to < count; ++to) {
      if (from != to) {
        Streams& group = from == start ? ours : meets(from, to, start, goal, count) ? met : others;
        group.ways.push_back({{arms[static_cast<std::size_t>(from)].name + "_in",
                               arms[static_cast<std::size_t>(to)].name + "_out"}});
      }
    }
  }
  RoadTraffic traffic{{}, {}, {met, ours}};
  if (!others.ways.empty()) {
    traffic.streams.push_back(others);
  }
  return traffic;
}

Road with_traffic(Road road, RoadTraffic traffic) {
  road.smarts = std::move(traffic);
  road.social = with_social_drivers(road.smarts);
  return road;
}

/// What a driver turns by from one arm to another, left positive.
double turn_between(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad - std::numbers::pi, 2.0 * std::numbers::pi);
}

/// \param turn  the goal's arm, counted counterclockwise from the start's: 1 the first to the right
/// \param least_deg, most_deg  of what one turns by on the way, left positive
Road draw_junction(Random& random, int count, int turn, double least_deg, double most_deg) {
  const int start = random.integer(0, count - 1);
  const int goal = (start + turn) % count;
  std::vector<double> directions;
  double turn_deg = 0.0;
  do {
    directions = draw_directions(random, count, kApart_rad);
    turn_deg = turn_between(directions[static_cast<std::size_t>(start)],
                            directions[static_cast<std::size_t>(goal)]) /
               kDegree_rad;
  } while (turn_deg < least_deg || turn_deg > most_deg);
  // Not `unregulated`: SUMO's drivers do not look at each other there, and no law says who had to.
  const std::string type = one_of<std::string>(
      {"priority", "priority", "priority", "priority_stop", "allway_stop", "right_before_left", "priority"},
      random);
  const bool ranked = type.starts_with("priority");
  const int main = random.integer(0, count - 1);
  // The major road goes on opposite, or now and then round the corner.
  const int onward = (main + (random.uniform() < 0.75 ? count / 2 : 1)) % count;
  const int main_lanes = one_of<int>({1, 1, 2, 2, 3, 4}, random);
  std::vector<Arm> arms;
  for (int i = 0; i < count; ++i) {
    Arm arm{std::string(1, "stuv"[i]), directions[static_cast<std::size_t>(i)]};
    arm.length_m = draw_length_m(random, kShortestArm_m, kLongestArm_m);
    const int minor_lanes = one_of<int>({1, 1, 1, 2, 2, 3, 4}, random);
    if (ranked) {
      const bool major = i == main || i == onward;
      arm.lanes_in = arm.lanes_out = major ? main_lanes : minor_lanes;
      arm.priority = major ? 5 : 1;
    }
    arms.push_back(arm);
  }
  const Arm& from = arms[static_cast<std::size_t>(start)];
  const Arm& to = arms[static_cast<std::size_t>(goal)];
  const double corner_m = random.uniform(4.0, 12.0);
  const double speed_mps = one_of<double>({8.33, 11.11, 13.89, 16.67}, random);
  Road road;
  road.network = star(arms, type, corner_m, reach_of(arms, corner_m), speed_mps);
  road.mission = draw_mission(random);
  road.mission.start_edge = from.name + "_in";
  road.mission.start_lane = random.integer(0, from.lanes_in - 1);
  road.mission.goal_edge = to.name + "_out";
  road.mission.goal_lane = random.integer(0, to.lanes_out - 1);
  return with_traffic(road, traffic_between(arms, start, goal, random));
}

/// Lane of `lanes`, `away` from the outermost one to that side.
int lane_from(bool left, int lanes, int away) {
  return left ? lanes - 1 - away : away;
}

}  // namespace

Road draw_crossing_left(Random& random) {
  return draw_junction(random, 4, 3, 30.0, 135.0);
}

Road draw_crossing_straight(Random& random) {
  return draw_junction(random, 4, 2, -40.0, 40.0);
}

Road draw_crossing_right(Random& random) {
  return draw_junction(random, 4, 1, -135.0, -30.0);
}

Road draw_tee_left(Random& random) {
  return draw_junction(random, 3, 2, 30.0, 135.0);
}

Road draw_tee_right(Random& random) {
  return draw_junction(random, 3, 1, -135.0, -30.0);
}

/// From the west; only the outermost lanes turn.
Road draw_late_change(Random& random) {
  constexpr double kJitter_rad = 25.0 * kDegree_rad;
  constexpr double kPerChange_m = 60.0;  // at most; the least is what fits() asks for
  const bool left = random.integer(0, 1) == 1;
  const bool west_is_major = random.integer(0, 1) == 1;
  std::vector<Arm> arms;
  for (int i = 0; i < 4; ++i) {  // east, north, west, south
    Arm arm{std::string(1, "enws"[i])};
    arm.direction_rad = 90.0 * kDegree_rad * i + random.uniform(-kJitter_rad, kJitter_rad);
    arm.length_m = draw_length_m(random, kShortestArm_m, kLongestArm_m);
    arm.lanes_in = arm.lanes_out = random.integer(1, 2);
    arm.priority = (i % 2 == 0) == west_is_major ? 5 : 1;
    arms.push_back(arm);
  }
  Arm& west = arms[2];
  Arm& exit = arms[left ? 1 : 3];
  west.lanes_in = random.integer(2, 4);
  arms[0].lanes_out = west.lanes_in;
  exit.lanes_out = random.integer(2, 4);
  const int before = random.integer(1, std::min(2, west.lanes_in - 1));
  const int after = random.integer(1, std::min(2, exit.lanes_out - 1));
  west.length_m = 8.0 + before * draw_length_m(random, kShortestArm_m, kPerChange_m);
  exit.length_m = after * draw_length_m(random, kShortestArm_m, kPerChange_m);
  const double corner_m = random.uniform(4.0, 12.0);
  const double speed_mps = one_of<double>({8.33, 11.11, 13.89}, random);
  Road road;
  road.network = star(arms, "priority", corner_m, reach_of(arms, corner_m), speed_mps);
  const int outermost = west.lanes_in - 1;
  road.network.connections = {{"w_in", "s_out", 0, 0}, {"w_in", "n_out", outermost, arms[1].lanes_out - 1}};
  for (int lane = outermost == 1 ? 0 : 1; lane < outermost; ++lane) {
    road.network.connections.push_back({"w_in", "e_out", lane, lane});
  }
  road.mission = draw_mission(random);
  road.mission.start_edge = "w_in";
  road.mission.start_lane = lane_from(left, west.lanes_in, before);
  road.mission.goal_edge = exit.name + "_out";
  road.mission.goal_lane = lane_from(left, exit.lanes_out, after);
  return with_traffic(road, traffic_between(arms, 2, left ? 1 : 3, random));
}

/// \code
///        ring_1
///    1 o--------o 0      nodes counterclockwise, a ring edge from each to the next
///      |        |        arm k leads into and out of node k
///    2 o--------o 3
/// \endcode
Road draw_roundabout(Random& random) {
  constexpr double kRingApart_rad = 60.0 * kDegree_rad;
  constexpr int kArcPoints = 12;
  const int count = random.integer(3, 5);
  const std::vector<double> directions = draw_directions(random, count, kRingApart_rad);
  const double radius_m = random.uniform(16.0, 32.0);
  const int ring_lanes = one_of<int>({1, 1, 1, 2}, random);
  const double speed_mps = one_of<double>({8.33, 11.11, 13.89}, random);
  const auto node = [](int k) { return "r" + std::to_string(k); };
  const auto ring = [](int k) { return "ring_" + std::to_string(k); };
  Road road;
  std::vector<Arm> arms;
  for (int k = 0; k < count; ++k) {
    Arm arm{std::string(1, "stuvw"[k]), directions[static_cast<std::size_t>(k)]};
    arm.length_m = draw_length_m(random, kShortestArm_m, kLongestArm_m);
    arm.lanes_in = arm.lanes_out = random.integer(1, ring_lanes);
    arms.push_back(arm);
    const double next_rad = k + 1 < count ? directions[static_cast<std::size_t>(k) + 1]
                                          : directions.front() + 2.0 * std::numbers::pi;
    const double corner_m = 4.0;
    const std::string name = node(k);
    road.network.nodes.push_back({name, polar(radius_m, arm.direction_rad), "priority", corner_m});
    road.network.nodes.push_back({arm.name, polar(radius_m + 10.0 + arm.length_m, arm.direction_rad)});
    road.network.edges.push_back({arm.name + "_in", arm.name, name, arm.lanes_in, speed_mps, 1});
    road.network.edges.push_back({arm.name + "_out", name, arm.name, arm.lanes_out, speed_mps, 1});
    PlainEdge arc{ring(k), name, node((k + 1) % count), ring_lanes, 8.33, 3};
    for (int i = 0; i <= kArcPoints; ++i) {
      arc.shape.push_back(polar(radius_m, arm.direction_rad + (next_rad - arm.direction_rad) * i /
                                                                  static_cast<double>(kArcPoints)));
    }
    road.network.edges.push_back(arc);
  }
  const auto way = [&](int from, int to) {
    std::vector<std::string> edges{arms[static_cast<std::size_t>(from)].name + "_in"};
    for (int k = from; k != to; k = (k + 1) % count) {
      edges.push_back(ring(k));
    }
    edges.push_back(arms[static_cast<std::size_t>(to)].name + "_out");
    return scenario::TrafficRoute{edges};
  };
  const int start = random.integer(0, count - 1);
  const int goal = (start + random.integer(1, count - 1)) % count;
  Streams streams = draw_crossing_streams(random);
  for (int from = 0; from < count; ++from) {
    for (int to = 0; to < count; ++to) {
      if (from != to) {
        streams.ways.push_back(way(from, to));
      }
    }
  }
  const Arm& from = arms[static_cast<std::size_t>(start)];
  const Arm& to = arms[static_cast<std::size_t>(goal)];
  road.mission = draw_mission(random);
  road.mission.start_edge = from.name + "_in";
  road.mission.start_lane = random.integer(0, from.lanes_in - 1);
  road.mission.goal_edge = to.name + "_out";
  road.mission.goal_lane = random.integer(0, to.lanes_out - 1);
  return with_traffic(road, {{}, {}, {streams}});
}

}  // namespace s4tp::roads
