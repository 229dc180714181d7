#include "sim_host/world/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <toml.hpp>

namespace s4tp::world {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& key, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + key + ": " + what);
}

/// A TOML table of which every key must be asked for: one left over is an error that names the accepted ones.
class Table {
 public:
  Table(const std::filesystem::path& file, std::string path, const toml::value& value)
      : file_(file), path_(std::move(path)), value_(value) {
    if (!value.is_table()) {
      fail(file_, path_, "expected a table");
    }
  }

  const std::filesystem::path& file() const { return file_; }
  std::string name_of(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  /// \return null when the key is missing
  const toml::value* find(const std::string& key) {
    accepted_.insert(key);
    return value_.contains(key) ? &value_.at(key) : nullptr;
  }
  const toml::value& require(const std::string& key) {
    const toml::value* found = find(key);
    if (found == nullptr) {
      fail(file_, name_of(key), "missing");
    }
    return *found;
  }

  double number(const std::string& key, double missing, double low, double high) {
    const toml::value* found = find(key);
    return found == nullptr ? missing : number_of(key, *found, low, high);
  }
  int integer(const std::string& key, int missing, int low, int high) {
    const toml::value* found = find(key);
    if (found == nullptr) {
      return missing;
    }
    if (!found->is_integer() || found->as_integer() < low || found->as_integer() > high) {
      fail(file_, name_of(key),
           "expected an integer from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return static_cast<int>(found->as_integer());
  }
  bool boolean(const std::string& key, bool missing) {
    const toml::value* found = find(key);
    if (found != nullptr && !found->is_boolean()) {
      fail(file_, name_of(key), "expected true or false");
    }
    return found == nullptr ? missing : found->as_boolean();
  }
  /// A number, or [low, high].
  Range range(const std::string& key, double low, double high) {
    const toml::value& found = require(key);
    if (!found.is_array()) {
      const double value = number_of(key, found, low, high);
      return {value, value};
    }
    const toml::array& pair = found.as_array();
    if (pair.size() != 2) {
      fail(file_, name_of(key), "expected a number or [low, high]");
    }
    const Range range{number_of(key, pair[0], low, high), number_of(key, pair[1], low, high)};
    if (range.low > range.high) {
      fail(file_, name_of(key), "expected low <= high");
    }
    return range;
  }
  std::string text(const std::string& key, const std::string& missing) {
    const toml::value* found = find(key);
    if (found != nullptr && !found->is_string()) {
      fail(file_, name_of(key), "expected a string");
    }
    return found == nullptr ? missing : std::string(found->as_string());
  }
  std::vector<std::string> texts(const std::string& key) {
    const toml::value& found = require(key);
    std::vector<std::string> all;
    if (!found.is_array() || found.as_array().empty()) {
      fail(file_, name_of(key), "expected a list of strings, at least one");
    }
    for (const toml::value& each : found.as_array()) {
      if (!each.is_string()) {
        fail(file_, name_of(key), "expected a list of strings");
      }
      all.push_back(each.as_string());
    }
    return all;
  }
  std::vector<Table> tables(const std::string& key) {
    std::vector<Table> all;
    if (const toml::value* found = find(key)) {
      if (!found->is_array()) {
        fail(file_, name_of(key), "expected a list of tables");
      }
      for (const toml::value& each : found->as_array()) {
        all.emplace_back(file_, name_of(key) + "[" + std::to_string(all.size()) + "]", each);
      }
    }
    return all;
  }

  void no_other_keys() const {
    for (const auto& [key, value] : value_.as_table()) {
      if (accepted_.count(key) == 0) {
        std::string list;
        for (const std::string& name : accepted_) {
          list += (list.empty() ? "" : ", ") + name;
        }
        fail(file_, name_of(key), "unknown key; accepted here: " + list);
      }
    }
  }

 private:
  double number_of(const std::string& key, const toml::value& value, double low, double high) const {
    const double number = value.is_integer()    ? static_cast<double>(value.as_integer())
                          : value.is_floating() ? value.as_floating()
                                                : std::nan("");
    if (!(number >= low && number <= high)) {
      std::ostringstream limits;
      limits << "expected a number from " << low << " to " << high;
      fail(file_, name_of(key), limits.str());
    }
    return number;
  }

  std::filesystem::path file_;
  std::string path_;
  const toml::value& value_;
  std::set<std::string> accepted_;
};

/// Lane `index` (SUMO's number) of an edge; kNoLane for -1.
LaneId lane_of(const Table& table, const std::string& key, const Network& network, const std::string& edge,
               int index) {
  if (index < 0) {
    return kNoLane;
  }
  for (const LaneId lane : network.lanes_of(edge)) {
    if (network.lanes[static_cast<std::size_t>(lane)].index == index) {
      return lane;
    }
  }
  fail(table.file(), table.name_of(key),
       "edge \"" + edge + "\" has no lane " + std::to_string(index) + " that cars may use");
}

void check_route(const Table& table, const std::string& key, const Network& network,
                 const std::vector<std::string>& edges, LaneId goal_lane) {
  try {
    RouteGuide(network, edges, goal_lane, 0.0);
  } catch (const std::runtime_error& error) {
    fail(table.file(), table.name_of(key), error.what());
  }
}

Mission read_mission(Table table, const Network& network) {
  Mission mission;
  mission.edges = table.texts("route");
  mission.start_edge = mission.edges.front();
  mission.start_lane = table.integer("start_lane", 0, 0, 99);
  mission.start_s_m = table.number("start_m", 5.0, 0.0, 1e5);
  mission.start_speed_mps = table.number("start_speed_mps", mission.start_speed_mps, 0.0, 60.0);
  mission.goal_lane = table.integer("goal_lane", 0, 0, 99);
  const double goal_m = table.number("goal_m", 0.0, -1e5, 1e5);
  const bool goal_at_end = table.find("goal_m") == nullptr;
  mission.entry_time_s = table.number("entry_time_s", mission.entry_time_s, 0.0, 600.0);
  mission.time_limit_s = table.number("time_limit_s", mission.time_limit_s, 1.0, 3600.0);
  table.no_other_keys();

  check_route(table, "route", network, mission.edges, kNoLane);
  const LaneId start = lane_of(table, "start_lane", network, mission.start_edge, mission.start_lane);
  const LaneId goal = lane_of(table, "goal_lane", network, mission.edges.back(), mission.goal_lane);
  const double start_length_m = network.lanes[static_cast<std::size_t>(start)].centre.length_m();
  const double goal_length_m = network.lanes[static_cast<std::size_t>(goal)].centre.length_m();
  if (mission.start_s_m > start_length_m) {
    fail(table.file(), table.name_of("start_m"), "the lane is " + std::to_string(start_length_m) + " m long");
  }
  mission.goal_s_m = goal_at_end ? goal_length_m : goal_m < 0.0 ? goal_length_m + goal_m : goal_m;
  if (mission.goal_s_m < 0.0 || mission.goal_s_m > goal_length_m) {
    fail(table.file(), table.name_of("goal_m"), "the lane is " + std::to_string(goal_length_m) + " m long");
  }
  return mission;
}

DriverModel read_driver(Table table) {
  DriverModel driver;
  const auto set = [&](const char* key, double& value, double low, double high) {
    value = table.number(key, value, low, high);
  };
  set("acceleration_mps2", driver.acceleration_mps2, 0.1, 10.0);
  set("deceleration_mps2", driver.deceleration_mps2, 0.1, 12.0);
  set("sigma", driver.sigma, 0.0, 1.0);
  set("headway_s", driver.headway_s, 0.1, 10.0);
  set("min_gap_mean_m", driver.min_gap_mean_m, 0.0, 50.0);
  set("min_gap_deviation_m", driver.min_gap_deviation_m, 0.0, 10.0);
  set("speed_factor_mean", driver.speed_factor_mean, 0.1, 3.0);
  set("speed_factor_deviation", driver.speed_factor_deviation, 0.0, 1.0);
  set("max_speed_mps", driver.max_speed_mps, 0.1, 60.0);
  driver.lane_keeping = table.boolean("lane_keeping", driver.lane_keeping);
  table.no_other_keys();
  return driver;
}

TrafficRoute read_route(Table table, const Network& network) {
  TrafficRoute route;
  route.edges = table.texts("edges");
  route.start_lane = table.integer("start_lane", -1, -1, 99);
  route.end_lane = table.integer("end_lane", -1, -1, 99);
  table.no_other_keys();
  check_route(table, "edges", network, route.edges, kNoLane);
  static_cast<void>(lane_of(table, "start_lane", network, route.edges.front(), route.start_lane));
  static_cast<void>(lane_of(table, "end_lane", network, route.edges.back(), route.end_lane));
  return route;
}

FlowGroup read_flow(Table table, const Network& network) {
  FlowGroup group;
  for (const Table& route : table.tables("routes")) {
    group.routes.push_back(read_route(route, network));
  }
  if (group.routes.empty()) {
    fail(table.file(), table.name_of("routes"), "expected at least one route");
  }
  const Range choose = table.range("choose", 0.0, static_cast<double>(group.routes.size()));
  group.choose_low = static_cast<int>(choose.low);
  group.choose_high = static_cast<int>(choose.high);
  if (group.choose_low != choose.low || group.choose_high != choose.high) {
    fail(table.file(), table.name_of("choose"), "expected integers");
  }
  group.vehicles_per_minute = table.range("vehicles_per_minute", 0.1, 120.0);
  group.begin_s = table.range("begin_s", 0.0, 600.0);
  const std::string spacing = table.text("spacing", "even");
  if (spacing != "even" && spacing != "random") {
    fail(table.file(), table.name_of("spacing"), "expected \"even\" or \"random\"");
  }
  group.random_spacing = spacing == "random";
  if (const toml::value* driver = table.find("driver")) {
    group.driver = read_driver(Table(table.file(), table.name_of("driver"), *driver));
  }
  table.no_other_keys();
  return group;
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "scenario.toml";
  if (!std::filesystem::exists(file)) {
    fail(file, "the file", "there is none; a scenario is a folder that holds a scenario.toml");
  }
  toml::value document;
  try {
    document = toml::parse(file.string());
  } catch (const std::exception& error) {
    fail(file, "TOML", error.what());
  }
  Table table(file, "", document);
  Scenario scenario;
  scenario.folder = folder;
  scenario.name = std::filesystem::weakly_canonical(folder).filename().string();
  scenario.network = load_network(folder / table.text("network", "network.net.xml"));
  scenario.mission = read_mission(Table(file, "mission", table.require("mission")), scenario.network);
  for (const Table& flow : table.tables("flow")) {
    scenario.flows.push_back(read_flow(flow, scenario.network));
  }
  table.no_other_keys();
  return scenario;
}

}  // namespace s4tp::world
