#include "sim_host/world/scenario/traffic_table.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim_host/world/scenario/route_file.hpp"
#include "sim_host/world/scenario/traffic_limits.hpp"

namespace s4tp::scenario {
namespace {

constexpr std::size_t kMixMax = 100;

/// \param base  what is not said here is as there
DriverModel read_driver(TomlTable& table, const DriverModel& base) {
  DriverModel driver = base;
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
  set("svo_rad", driver.svo_rad, -1.6, 1.6);
  driver.lane_keeping = table.boolean("lane_keeping", driver.lane_keeping);
  return driver;
}

/// [traffic.driver] is what all have in common; [[traffic.mix]], or the file it names, the kinds of them.
std::vector<DriverModel> read_drivers(TomlTable& traffic, const std::filesystem::path& folder,
                                      std::vector<std::filesystem::path>& files) {
  TomlTable common = traffic.table("driver");
  const DriverModel base = read_driver(common, {});
  common.no_other_keys();
  const toml::value* mix = traffic.find("mix");
  if (mix == nullptr) {
    return {base};
  }
  const auto read = [&](std::vector<TomlTable> kinds) {
    std::vector<DriverModel> drivers;
    for (TomlTable& kind : kinds) {
      drivers.push_back(read_driver(kind, base));
      drivers.back().name = kind.text("name", "");
      drivers.back().weight = kind.number("weight", 1.0, 0.001, 1000.0);
      kind.no_other_keys();
    }
    if (drivers.empty() || drivers.size() > kMixMax) {
      traffic.fail("mix", "expected 1 to " + std::to_string(kMixMax) + " kinds of drivers");
    }
    return drivers;
  };
  if (!mix->is_string()) {
    return read(traffic.tables("mix"));
  }
  const std::filesystem::path file = folder / mix->as_string().str;
  const toml::value document = parse_toml(file);
  files.push_back(file);
  TomlTable table(file.string(), "", document);
  const std::vector<DriverModel> drivers = read(table.tables("mix"));
  table.no_other_keys();
  return drivers;
}

/// \param lane  SUMO's number; -1: any
void check_lane_number(const TomlTable& table, const std::string& key, const map::Network& network,
                       const std::string& edge, int lane) {
  if (lane >= 0 && network.lane_of(edge, lane) == map::kNoLane) {
    table.fail(key, "edge \"" + edge + "\" has no lane " + std::to_string(lane) + " that cars may use");
  }
}

TrafficRoute read_route(TomlTable table, const map::Network& network) {
  TrafficRoute route;
  route.edges = table.texts("edges");
  route.start_lane = table.integer("start_lane", -1, -1, 99);
  route.end_lane = table.integer("end_lane", -1, -1, 99);
  table.no_other_keys();
  try {
    map::RouteGuide(network, route.edges, map::kNoLane, 0.0);
  } catch (const std::runtime_error& error) {
    table.fail("edges", error.what());
  }
  check_lane_number(table, "start_lane", network, route.edges.front(), route.start_lane);
  check_lane_number(table, "end_lane", network, route.edges.back(), route.end_lane);
  return route;
}

FlowGroup read_flow(TomlTable table, const map::Network& network, const std::vector<DriverModel>& drivers) {
  FlowGroup group;
  group.drivers = drivers;
  for (const TomlTable& route : table.tables("routes")) {
    group.routes.push_back(read_route(route, network));
  }
  if (group.routes.empty()) {
    table.fail("routes", "expected at least one route");
  }
  const Range choose = table.range("choose", 0.0, static_cast<double>(group.routes.size()));
  group.choose_low = static_cast<int>(choose.low);
  group.choose_high = static_cast<int>(choose.high);
  if (group.choose_low != choose.low || group.choose_high != choose.high) {
    table.fail("choose", "expected integers");
  }
  group.vehicles_per_minute = table.range("vehicles_per_minute", 0.1, 120.0);
  group.begin_s = table.range("begin_s", 0.0, 600.0);
  const std::string spacing = table.text("spacing", "even");
  if (spacing != "even" && spacing != "random") {
    table.fail("spacing", "expected \"even\" or \"random\"");
  }
  group.random_spacing = spacing == "random";
  for (DriverModel& driver : group.drivers) {  // what this flow says goes before what all have in common
    TomlTable own = table.table("driver");
    driver = read_driver(own, driver);
    own.no_other_keys();
  }
  table.no_other_keys();
  return group;
}

}  // namespace

void read_traffic(TomlTable traffic, Scenario& scenario) {
  const bool from_files = traffic.find("routes") != nullptr;
  const bool drawn = traffic.find("flow") != nullptr;
  if (from_files && (drawn || traffic.find("driver") != nullptr || traffic.find("mix") != nullptr)) {
    traffic.fail("routes", "expected either route files, which say everything, or flow, driver and mix");
  }
  if (from_files) {
    for (const std::string& name : traffic.texts("routes")) {
      const std::filesystem::path file = scenario.folder / name;
      if (!std::filesystem::exists(file)) {
        traffic.fail("routes", "there is no file " + file.string());
      }
      scenario.route_files.push_back(file);
      scenario.files.push_back(file);
      scenario.demands.push_back(load_demand(file, scenario.network));
      for (const std::string& note : scenario.demands.back().notes) {
        scenario.notes.push_back(file.string() + ": " + note);
      }
    }
  } else {
    const std::vector<DriverModel> drivers = read_drivers(traffic, scenario.folder, scenario.files);
    double cars = 0.0;
    for (const TomlTable& flow : traffic.tables("flow")) {
      scenario.flows.push_back(read_flow(flow, scenario.network, drivers));
      const FlowGroup& group = scenario.flows.back();
      const double routes = std::min<double>(group.choose_high, static_cast<double>(group.routes.size()));
      cars += routes * group.vehicles_per_minute.high * kCarsCounted_s / 60.0;
      if (cars > kCarsMax) {
        traffic.fail("flow", "more than " + std::to_string(static_cast<int>(kCarsMax)) + " cars until " +
                                 std::to_string(static_cast<int>(kCarsCounted_s)) + " s");
      }
    }
  }
  traffic.no_other_keys();
}

}  // namespace s4tp::scenario
