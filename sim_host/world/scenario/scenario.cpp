#include "sim_host/world/scenario/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "sim_host/world/map/find_route.hpp"
#include "sim_host/world/scenario/cut.hpp"
#include "sim_host/world/scenario/listed.hpp"
#include "sim_host/world/scenario/route_file.hpp"
#include "sim_host/world/scenario/toml_table.hpp"
#include "sim_host/world/scenario/traffic_limits.hpp"
#include "sim_host/world/scenario/utf8.hpp"

namespace s4tp::world {
namespace {

constexpr std::size_t kMixMax = 100;
constexpr double kReach_m = 1300.0;  ///< of Pose on the bus, with something to spare
constexpr double kEnd = std::numeric_limits<double>::infinity();  ///< of a lane
constexpr double kAsTheLane = -1.0;                               ///< the lane's end, the lane's limit

/// Lane by SUMO's name.
LaneId read_lane(TomlTable& table, const std::string& key, const Network& network) {
  const std::string name = table.text(key);
  const LaneId lane = network.find(name);
  if (lane == kNoLane || network.lanes[static_cast<std::size_t>(lane)].in_junction) {
    table.fail(key, "the network has no lane \"" + name + "\" outside junctions that cars may use");
  }
  return lane;
}

/// A number, or -1 for what the lane has.
double read_or(TomlTable& table, const std::string& key, double missing, double high, double of_the_lane) {
  const double value = table.number(key, missing, kAsTheLane, high);
  if (value < 0.0 && value != kAsTheLane) {
    table.fail(key, "expected a number of 0 and more, or -1: what the lane has");
  }
  return value == kAsTheLane ? of_the_lane : value;
}

/// A position as SUMO counts it, along the lane's shape.
double along_shape(const TomlTable& table, const std::string& key, const NetworkLane& lane, double s_m) {
  const double shape_m = lane.centre.length_m();
  if (s_m == kEnd) {
    return shape_m;
  }
  const double longest_m = std::max(shape_m, lane.sumo_length_m);
  if (s_m > longest_m) {
    table.fail(key, "the lane is " + std::to_string(longest_m) + " m long");
  }
  // The two differ by more than rounding where the network was built without lanes inside junctions.
  const bool differ = lane.sumo_length_m > 0.0 && std::abs(shape_m - lane.sumo_length_m) > 0.1;
  return std::min(differ ? s_m * shape_m / lane.sumo_length_m : s_m, shape_m);
}

/// The odometry frame of the bus begins where the ego does.
void check_reach(const Network& network, const Mission& mission) {
  const Vec2 origin =
      network.lanes[static_cast<std::size_t>(mission.start_lane)].centre.at(mission.start_s_m).point;
  for (const std::string& edge : mission.edges) {
    for (const LaneId lane : network.lanes_of(edge)) {
      for (const Vec2 point : network.lanes[static_cast<std::size_t>(lane)].centre.points()) {
        const bool on_the_way = edge != mission.edges.front() && edge != mission.edges.back();
        if (on_the_way && std::max(std::abs(point.x - origin.x), std::abs(point.y - origin.y)) > kReach_m) {
          throw std::runtime_error("edge \"" + edge +
                                   "\" of the way lies more than 1.3 km from the start, "
                                   "as far as a pose on the bus reaches");
        }
      }
    }
  }
  const Vec2 goal =
      network.lanes[static_cast<std::size_t>(mission.goal_lane)].centre.at(mission.goal_s_m).point;
  if (std::max(std::abs(goal.x - origin.x), std::abs(goal.y - origin.y)) > kReach_m) {
    throw std::runtime_error(
        "the goal lies more than 1.3 km from the start, as far as a pose on the bus reaches");
  }
}

Mission read_mission(TomlTable table, const Network& network) {
  Mission mission;
  mission.start_lane = read_lane(table, "start_lane", network);
  mission.goal_lane = read_lane(table, "goal_lane", network);
  mission.start_s_m = table.number("start_pos_m", 5.0, 0.0, 1e6);
  const NetworkLane& start = network.lanes[static_cast<std::size_t>(mission.start_lane)];
  const NetworkLane& goal = network.lanes[static_cast<std::size_t>(mission.goal_lane)];
  mission.goal_s_m = read_or(table, "goal_pos_m", kAsTheLane, 1e6, kEnd);
  mission.entry_time_s = table.number("entry_time_s", mission.entry_time_s, 0.0, 600.0);
  mission.time_limit_s = table.number("time_limit_s", mission.time_limit_s, 1.0, 3600.0);
  mission.start_speed_mps = read_or(table, "entry_speed_mps", kAsTheLane, 60.0, start.speed_limit_mps);
  table.no_other_keys();
  mission.start_s_m = along_shape(table, "start_pos_m", start, mission.start_s_m);
  mission.goal_s_m = along_shape(table, "goal_pos_m", goal, mission.goal_s_m);
  try {
    mission.edges =
        find_route(network, mission.start_lane, mission.start_s_m, mission.goal_lane, mission.goal_s_m);
    RouteGuide(network, mission.edges, mission.goal_lane, mission.goal_s_m);
    check_reach(network, mission);
  } catch (const std::runtime_error& error) {
    table.fail("goal_lane", error.what());
  }
  return mission;
}

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
void check_lane_number(const TomlTable& table, const std::string& key, const Network& network,
                       const std::string& edge, int lane) {
  if (lane >= 0 && network.lane_of(edge, lane) == kNoLane) {
    table.fail(key, "edge \"" + edge + "\" has no lane " + std::to_string(lane) + " that cars may use");
  }
}

TrafficRoute read_route(TomlTable table, const Network& network) {
  TrafficRoute route;
  route.edges = table.texts("edges");
  route.start_lane = table.integer("start_lane", -1, -1, 99);
  route.end_lane = table.integer("end_lane", -1, -1, 99);
  table.no_other_keys();
  try {
    RouteGuide(network, route.edges, kNoLane, 0.0);
  } catch (const std::runtime_error& error) {
    table.fail("edges", error.what());
  }
  check_lane_number(table, "start_lane", network, route.edges.front(), route.start_lane);
  check_lane_number(table, "end_lane", network, route.edges.back(), route.end_lane);
  return route;
}

FlowGroup read_flow(TomlTable table, const Network& network, const std::vector<DriverModel>& drivers) {
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

/// Puts [flavour.NAME] over the rest. A scenario without any flavours is what it is, whichever is asked for.
toml::value in_flavour(toml::value document, const std::string& file, const std::string& flavour) {
  if (!document.is_table() || !document.contains("flavour")) {
    return document;
  }
  const toml::value flavours = document.at("flavour");
  TomlTable table(file, "flavour", flavours);
  document.as_table().erase("flavour");
  if (const toml::value* over = flavour.empty() ? nullptr : table.find(flavour)) {
    TomlTable check(file, table.name_of(flavour), *over);
    static_cast<void>(check.find("mission"));
    static_cast<void>(check.find("traffic"));
    check.no_other_keys();
    merge(document, *over);
  } else if (!flavour.empty() && flavour != "smarts") {
    std::set<std::string> names{"smarts"};
    for (const auto& [name, unused] : flavours.as_table()) {
      names.insert(name);
    }
    table.fail(flavour, "there is no such flavour; there are: " + listed(names));
  }
  return document;
}

/// \param may_be_cut  false for what a cut was cut out of
Scenario load(const std::filesystem::path& path, const std::string& flavour, bool may_be_cut) {
  namespace fs = std::filesystem;
  const bool is_file = path.extension() == ".toml" && !fs::is_directory(path);
  const fs::path file = is_file ? path : path / "scenario.toml";
  if (!fs::is_regular_file(file)) {
    throw std::runtime_error(file.string() +
                             ": there is no such file; a scenario is a folder that holds a scenario.toml, "
                             "or such a file itself");
  }
  const fs::path whole = fs::weakly_canonical(file);
  require_utf8(path);
  require_utf8(whole.filename() == "scenario.toml" ? whole.parent_path().filename() : whole.stem());
  const std::string shown = file.string() + (flavour.empty() ? "" : " (" + flavour + ")");
  const toml::value document = in_flavour(parse_toml(file), shown, flavour);
  const std::string name =
      (whole.filename() == "scenario.toml" ? whole.parent_path().filename() : whole.stem()).string();
  TomlTable table(shown, "", document);
  if (document.is_table() && document.contains("cut")) {
    Cut cut = read_cut(table.table("cut"), file);
    table.no_other_keys();
    if (!may_be_cut) table.fail("cut", "expected a scenario that is no cut itself");
    Scenario scenario = load(cut.of, cut.flavour, false);
    scenario.name = name;
    scenario.files.insert(scenario.files.begin(), {file, cut.commands_file});
    scenario.cut = std::make_shared<const Cut>(std::move(cut));
    return scenario;
  }
  Scenario scenario;
  scenario.folder = file.parent_path();
  scenario.name = name;
  scenario.flavour = flavour;
  scenario.files.push_back(file);
  TomlTable network = table.table("network");
  scenario.network_file = scenario.folder / network.text("file");
  if (!fs::is_regular_file(scenario.network_file)) {
    network.fail("file", "there is no file " + scenario.network_file.string());
  }
  scenario.files.push_back(scenario.network_file);
  network.no_other_keys();
  scenario.network = load_network(scenario.network_file);
  static_cast<void>(table.require("mission"));
  scenario.mission = read_mission(table.table("mission"), scenario.network);
  read_traffic(table.table("traffic"), scenario);
  table.no_other_keys();
  return scenario;
}

}  // namespace

std::filesystem::path scenario_path(const std::filesystem::path& shipped, const std::string& name) {
  namespace fs = std::filesystem;
  const auto is_scenario = [](const fs::path& folder) {
    return fs::is_regular_file(folder / "scenario.toml");
  };
  const fs::path given = name;
  if (!given.has_parent_path() && is_scenario(shipped / name)) return shipped / name;
  if (given.has_parent_path() || fs::exists(given) || !fs::is_directory(shipped)) return given;
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(shipped)) {
    if (is_scenario(entry.path())) names.insert(entry.path().filename().string());
  }
  throw std::runtime_error(name + ": there is no such scenario; shipped are: " + listed(names) +
                           "; your own is a folder that holds a scenario.toml");
}

RouteGuide mission_guide(const Scenario& scenario) {
  const Mission& mission = scenario.mission;
  return {scenario.network, mission.edges, mission.goal_lane, mission.goal_s_m};
}

Scenario load_scenario(const std::filesystem::path& path, const std::string& flavour) {
  return load(path, flavour, true);
}

}  // namespace s4tp::world
