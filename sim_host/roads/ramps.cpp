/// Ramps, and roads that lose a lane. Along the x axis; lanes lie to the right of y = 0.

#include <cmath>
#include <numbers>

#include "sim_host/roads/draws.hpp"

namespace s4tp::roads {
namespace {

using traffic::Random;

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kLongestRamp_m = 150.0;
constexpr int kRoadPriority = 9;

/// Centre line of a ramp of one lane that ends at the origin along the x axis: straight, then an arc.
/// \param angle_rad  of the straight part  \param arc_m  0: straight all the way, ends at that angle
std::vector<map::Vec2> ramp_shape(double length_m, double angle_rad, double arc_m) {
  std::vector<map::Vec2> shape;
  if (arc_m > 0.0) {
    constexpr int kPoints = 12;
    const double radius_m = arc_m / angle_rad;
    for (int i = 0; i < kPoints; ++i) {
      const double turned_rad = angle_rad * i / kPoints;
      shape.push_back({-radius_m * std::sin(turned_rad), -radius_m * (1.0 - std::cos(turned_rad))});
    }
    shape.push_back({-radius_m * std::sin(angle_rad), -radius_m * (1.0 - std::cos(angle_rad))});
  } else {
    shape.push_back({});
  }
  const double rest_m = std::max(1.0, length_m - arc_m);
  shape.push_back(
      {shape.back().x - rest_m * std::cos(angle_rad), shape.back().y - rest_m * std::sin(angle_rad)});
  return {shape.rbegin(), shape.rend()};
}

std::vector<map::Vec2> moved(std::vector<map::Vec2> shape, map::Vec2 by) {
  for (map::Vec2& point : shape) {
    point = {point.x + by.x, point.y + by.y};
  }
  return shape;
}

/// Every lane of the road has its stream.
Road with_stream(Road road, const std::vector<std::string>& edges, Random& random) {
  Streams streams;
  streams.ways = {{edges}};
  streams.vehicles_per_minute = draw_rate(random);
  road.smarts.streams = {streams};
  road.social = with_social_drivers(road.smarts);
  return road;
}

}  // namespace

Road draw_ramp_junction(Random& random) {
  const int lanes = random.integer(1, 4);
  const double speed_mps = one_of<double>({11.11, 13.89, 16.67, 22.22}, random);
  const double before_m = random.uniform(80.0, 200.0);
  const double after_m = random.uniform(50.0, 200.0);
  const double ramp_m = 10.0 + draw_length_m(random, kShortestArm_m, kLongestRamp_m);
  const double angle_rad = random.uniform(10.0, 60.0) * kDegree_rad;
  PlainEdge ramp{"ramp", "r", "j", 1, std::min(speed_mps, 13.89), 1};
  ramp.shape = moved(ramp_shape(ramp_m, angle_rad, 0.0), {-2.0, -(lanes - 0.5) * kLaneWidth_m});
  ramp.centred = true;
  Road road;
  road.network.nodes = {{"a", {-before_m, 0.0}},
                        {"r", ramp.shape.front()},
                        {"j", {0.0, 0.0}, "priority"},
                        {"b", {after_m, 0.0}}};
  road.network.edges = {{"main", "a", "j", lanes, speed_mps, kRoadPriority},
                        ramp,
                        {"on", "j", "b", lanes, speed_mps, kRoadPriority}};
  road.network.connections = {{"ramp", "on", 0, 0}};
  for (int lane = 0; lane < lanes; ++lane) {
    road.network.connections.push_back({"main", "on", lane, lane});
  }
  road.mission = draw_mission(random);
  road.mission.start_edge = "ramp";
  road.mission.goal_edge = "on";
  road.mission.goal_lane = random.integer(0, lanes - 1);
  return with_stream(road, {"main", "on"}, random);
}

Road draw_ramp_lane(Random& random) {
  const int lanes = random.integer(1, 5);
  const double speed_mps = one_of<double>({13.89, 16.67, 22.22}, random);
  const double before_m = random.uniform(80.0, 200.0);
  const double beside_m = random.uniform(40.0, 200.0);
  const double after_m = random.uniform(50.0, 200.0);
  const double ramp_m = draw_length_m(random, kShortestArm_m, kLongestRamp_m);
  const double angle_rad = random.uniform(8.0, 30.0) * kDegree_rad;
  const double arc_m = std::min(0.6 * ramp_m, random.uniform(15.0, 40.0));
  PlainEdge ramp{"ramp", "r", "j", 1, std::min(speed_mps, 16.67), 1};
  ramp.shape = moved(ramp_shape(ramp_m, angle_rad, arc_m), {-1.0, -(lanes + 0.5) * kLaneWidth_m});
  ramp.centred = true;
  Road road;
  road.network.nodes = {{"a", {-before_m, 0.0}},
                        {"r", ramp.shape.front()},
                        {"j", {0.0, 0.0}, "priority"},
                        {"k", {beside_m, 0.0}, "priority"},
                        {"b", {beside_m + after_m, 0.0}}};
  road.network.edges = {{"main", "a", "j", lanes, speed_mps, kRoadPriority},
                        ramp,
                        {"beside", "j", "k", lanes + 1, speed_mps, kRoadPriority},
                        {"on", "k", "b", lanes, speed_mps, kRoadPriority}};
  road.network.connections = {{"ramp", "beside", 0, 0}};
  for (int lane = 0; lane < lanes; ++lane) {
    road.network.connections.push_back({"main", "beside", lane, lane + 1});
    road.network.connections.push_back({"beside", "on", lane + 1, lane});
  }
  road.mission = draw_mission(random);
  road.mission.start_edge = "ramp";
  road.mission.goal_edge = "on";
  road.mission.goal_lane = random.integer(0, lanes - 1);
  return with_stream(road, {"main", "beside", "on"}, random);
}

/// One or two lanes end, on either side; at a zipper they run into the lane beside them.
Road draw_lane_drop(Random& random) {
  const int lanes = random.integer(2, 5);
  const int ending = random.integer(1, std::min(2, lanes - 1));
  const bool right = random.integer(0, 1) == 0;
  const bool zipper = ending == 1 && random.integer(0, 1) == 0;
  const double speed_mps = one_of<double>({11.11, 13.89, 16.67, 22.22}, random);
  const double before_m = random.uniform(50.0, 200.0);
  const double after_m = random.uniform(50.0, 200.0);
  const int left_over = lanes - ending;
  Road road;
  road.network.nodes = {{"a", {0.0, 0.0}},
                        {"z", {before_m, 0.0}, zipper ? "zipper" : "priority"},
                        {"b", {before_m + after_m, 0.0}}};
  road.network.edges = {{"wide", "a", "z", lanes, speed_mps}, {"narrow", "z", "b", left_over, speed_mps}};
  // Where the left lanes end, those that go on lie further right than the road's edge.
  if (!right) {
    const double shift_m = -ending * kLaneWidth_m;
    road.network.edges[1].shape = {{before_m + 1.0, shift_m}, {before_m + after_m, shift_m}};
  }
  for (int lane = 0; lane < lanes; ++lane) {
    const int to = right ? lane - ending : lane;
    if (to >= 0 && to < left_over) {
      road.network.connections.push_back({"wide", "narrow", lane, to});
    } else if (zipper) {
      road.network.connections.push_back({"wide", "narrow", lane, right ? 0 : left_over - 1});
    }
  }
  road.mission = draw_mission(random);
  road.mission.start_edge = "wide";
  road.mission.start_lane = random.integer(0, lanes - 1);
  road.mission.goal_edge = "narrow";
  road.mission.goal_lane = random.integer(0, left_over - 1);
  return with_stream(road, {"wide", "narrow"}, random);
}

}  // namespace s4tp::roads
