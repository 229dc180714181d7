#pragma once
/// A scenario: a network, a mission and traffic, described by a scenario.toml (sim_host/scenarios/README.md).

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

/// One kind of driver and car; SUMO's names and defaults.
struct DriverModel {
  std::string name;
  double weight = 1.0;  ///< share of this kind among those of its flow
  double acceleration_mps2 = 2.6;
  double deceleration_mps2 = 4.5;
  double sigma = 0.5;  ///< imperfection, 0 .. 1
  double headway_s = 1.0;
  double min_gap_mean_m = 2.5;
  double min_gap_deviation_m = 0.0;
  double speed_factor_mean = 1.0;
  double speed_factor_deviation = 0.1;
  double max_speed_mps = 55.0;
  double svo_rad = 0.0;       ///< social value orientation: 0 his own gain only, pi/4 that of others as much
  bool lane_keeping = false;  ///< never changes lane by its own wish
  double length_m = 5.0;
  double width_m = 1.8;
};

/// One way traffic may take: edges, and the lane it starts and ends in (SUMO's numbers; -1: any).
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
  bool random_spacing = false;           ///< exponential gaps instead of even ones
  std::vector<DriverModel> drivers{{}};  ///< each car draws one by weight; never empty
};

struct Mission {
  LaneId start_lane = 0;
  double start_s_m = 0.0;  ///< of the box centre, at entry
  double start_speed_mps = 8.0;
  std::vector<std::string> edges;  ///< route, from the start lane's edge to the goal lane's
  LaneId goal_lane = 0;
  double goal_s_m = 0.0;
  double entry_time_s = 4.0;   ///< the ECU takes over
  double time_limit_s = 80.0;  ///< after entry
};

struct Scenario {
  std::string name;
  std::string flavour;  ///< which of the file's [flavour.NAME] tables is in force; empty: none
  std::filesystem::path folder;
  std::filesystem::path network_file;
  std::vector<std::filesystem::path> route_files;  ///< the episode of seed s takes file s modulo their number
  Network network;
  Mission mission;
  std::vector<FlowGroup> flows;  ///< where there are no route files
};

/// Reads a scenario.toml, named itself or by its folder, and the files it names.
/// \param flavour  which [flavour.NAME] to put over the rest; empty or "smarts": the file as it is written
/// SCN-001 \throws std::runtime_error naming file, key, what was wrong and what is accepted
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& path, const std::string& flavour = {});

/// The folder of a shipped scenario by its name, else the path as given.
[[nodiscard]] std::filesystem::path scenario_path(const std::filesystem::path& shipped,
                                                  const std::string& name);

}  // namespace s4tp::world
