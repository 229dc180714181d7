#pragma once
/// A scenario: a folder with a network, a mission and the traffic to draw from, in scenario.toml.

#include <filesystem>
#include <string>
#include <vector>

#include "sim_host/world/network.hpp"

namespace s4tp::world {

/// A uniform range to draw from.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// How the drivers of a flow drive; SUMO's names and defaults.
struct DriverModel {
  double acceleration_mps2 = 2.6;
  double deceleration_mps2 = 4.5;
  double sigma = 0.5;  ///< imperfection, 0 .. 1
  double headway_s = 1.0;
  double min_gap_mean_m = 2.5;
  double min_gap_deviation_m = 0.0;
  double speed_factor_mean = 1.0;
  double speed_factor_deviation = 0.1;
  double max_speed_mps = 55.0;
  bool lane_keeping = false;  ///< never changes lane by its own wish
};

/// One way traffic may take: edges, and the lane it starts and ends in (-1: any).
struct TrafficRoute {
  std::vector<std::string> edges;
  int start_lane = -1;
  int end_lane = -1;
};

/// A group of possible flows, of which some are drawn in each episode.
struct FlowGroup {
  std::vector<TrafficRoute> routes;
  int choose_low = 1;  ///< how many of the routes are drawn
  int choose_high = 1;
  Range vehicles_per_minute;  ///< each flow's own rate
  Range begin_s;
  bool random_spacing = false;  ///< exponential gaps instead of even ones
  DriverModel driver;
};

struct Mission {
  std::string start_edge;
  int start_lane = 0;
  double start_s_m = 0.0;  ///< of the box centre, at entry
  double start_speed_mps = 8.0;
  std::vector<std::string> edges;  ///< route, start_edge first
  int goal_lane = 0;               ///< on the last edge
  double goal_s_m = 0.0;           ///< along the goal lane; the loader has resolved "from the end"
  double entry_time_s = 4.0;       ///< the ECU takes over
  double time_limit_s = 80.0;      ///< after entry
};

struct Scenario {
  std::string name;
  std::filesystem::path folder;
  Network network;
  Mission mission;
  std::vector<FlowGroup> flows;
};

/// Reads FOLDER/scenario.toml and the network it names.
/// SCN-001 \throws std::runtime_error naming file, key, what was wrong and what is accepted
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& folder);

}  // namespace s4tp::world
