#pragma once
/// A scenario: a network, a mission and traffic, described by a scenario.toml (sim_host/scenarios/README.md).

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/scenario/traffic_demand.hpp"

namespace s4tp::scenario {

struct Mission {
  map::LaneId start_lane = 0;
  double start_s_m = 0.0;  ///< of the box centre, at entry
  double start_speed_mps = 8.0;
  std::vector<std::string> edges;  ///< route, from the start lane's edge to the goal lane's
  map::LaneId goal_lane = 0;
  double goal_s_m = 0.0;
  double entry_time_s = 4.0;   ///< the ECU takes over
  double time_limit_s = 80.0;  ///< after entry
  double in_time_s = 80.0;     ///< a goal reached by then is counted apart; at most the limit
};

struct Cut;

struct Scenario {
  std::string name;
  std::string flavour;  ///< which of the file's [flavour.NAME] tables is in force; empty: none
  std::filesystem::path folder;
  std::filesystem::path network_file;
  std::vector<std::filesystem::path> route_files;  ///< the episode of seed s takes file s modulo their number
  map::Network network;
  Mission mission;
  std::vector<FlowGroup> flows;              ///< where there are no route files
  std::vector<Demand> demands;               ///< what the route files say, in their order
  std::vector<std::string> notes;            ///< what was left out because it does no harm, one line each
  std::vector<std::filesystem::path> files;  ///< all that was read, the scenario.toml first
  std::shared_ptr<const Cut> cut;            ///< null: driven from its beginning
};

/// The way of the mission. \param scenario  its network must outlive the guide
[[nodiscard]] map::RouteGuide mission_guide(const Scenario& scenario);

/// Reads a scenario.toml, named itself or by its folder, and the files it names.
/// \param flavour  which [flavour.NAME] to put over the rest; empty or "smarts": the file as it is written
/// SCN-001 \throws std::runtime_error naming file, key, what was wrong and what is accepted
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& path, const std::string& flavour = {});

/// The folder of a shipped scenario by its name, else the path as given.
/// SCN-004 \throws std::runtime_error naming the shipped ones where a name without a folder is neither
[[nodiscard]] std::filesystem::path scenario_path(const std::filesystem::path& shipped,
                                                  const std::string& name);

}  // namespace s4tp::scenario
