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
#include "sim_host/world/scenario/toml_table.hpp"
#include "sim_host/world/scenario/traffic_table.hpp"
#include "sim_host/world/scenario/utf8.hpp"

namespace s4tp::scenario {
namespace {

constexpr double kReach_m = 1300.0;  ///< of Pose on the bus, with something to spare
constexpr double kEnd = std::numeric_limits<double>::infinity();  ///< of a lane
constexpr double kAsTheLane = -1.0;                               ///< the lane's end, the lane's limit
constexpr double kBeforeJunction_m = 5.0;  ///< the middle of a car that waits before it

/// Lane by SUMO's name.
map::LaneId read_lane(TomlTable& table, const std::string& key, const map::Network& network) {
  const std::string name = table.text(key);
  const map::LaneId lane = network.find(name);
  if (lane == map::kNoLane || network.lanes[static_cast<std::size_t>(lane)].in_junction) {
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
double along_shape(const TomlTable& table, const std::string& key, const map::Lane& lane, double s_m) {
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
void check_reach(const map::Network& network, const Mission& mission) {
  const map::Vec2 origin =
      network.lanes[static_cast<std::size_t>(mission.start_lane)].centre.at(mission.start_s_m).point;
  for (const std::string& edge : mission.edges) {
    for (const map::LaneId lane : network.lanes_of(edge)) {
      for (const map::Vec2 point : network.lanes[static_cast<std::size_t>(lane)].centre.points()) {
        const bool on_the_way = edge != mission.edges.front() && edge != mission.edges.back();
        if (on_the_way && std::max(std::abs(point.x - origin.x), std::abs(point.y - origin.y)) > kReach_m) {
          throw std::runtime_error("edge \"" + edge +
                                   "\" of the way lies more than 1.3 km from the start, "
                                   "as far as a pose on the bus reaches");
        }
      }
    }
  }
  const map::Vec2 goal =
      network.lanes[static_cast<std::size_t>(mission.goal_lane)].centre.at(mission.goal_s_m).point;
  if (std::max(std::abs(goal.x - origin.x), std::abs(goal.y - origin.y)) > kReach_m) {
    throw std::runtime_error(
        "the goal lies more than 1.3 km from the start, as far as a pose on the bus reaches");
  }
}

Mission read_mission(TomlTable table, const map::Network& network) {
  Mission mission;
  mission.start_lane = read_lane(table, "start_lane", network);
  mission.goal_lane = read_lane(table, "goal_lane", network);
  mission.start_s_m = table.number("start_pos_m", 5.0, 0.0, 1e6);
  const map::Lane& start = network.lanes[static_cast<std::size_t>(mission.start_lane)];
  const map::Lane& goal = network.lanes[static_cast<std::size_t>(mission.goal_lane)];
  mission.goal_s_m = read_or(table, "goal_pos_m", kAsTheLane, 1e6, kEnd);
  mission.entry_time_s = table.number("entry_time_s", mission.entry_time_s, 0.0, 600.0);
  mission.time_limit_s = table.number("time_limit_s", mission.time_limit_s, 1.0, 3600.0);
  mission.in_time_s = table.number("in_time_s", mission.time_limit_s, 1.0, mission.time_limit_s);
  mission.start_speed_mps = read_or(table, "entry_speed_mps", kAsTheLane, 60.0, start.speed_limit_mps);
  table.no_other_keys();
  mission.start_s_m = along_shape(table, "start_pos_m", start, mission.start_s_m);
  const bool at_end = mission.goal_s_m == kEnd;
  mission.goal_s_m = along_shape(table, "goal_pos_m", goal, mission.goal_s_m);
  // A lane that leads on ends where one has to give way: who waits there has arrived.
  if (at_end && !goal.successors.empty()) {
    mission.goal_s_m = std::max(0.5 * mission.goal_s_m, mission.goal_s_m - kBeforeJunction_m);
  }
  try {
    mission.edges =
        map::find_route(network, mission.start_lane, mission.start_s_m, mission.goal_lane, mission.goal_s_m);
    map::RouteGuide(network, mission.edges, mission.goal_lane, mission.goal_s_m);
    check_reach(network, mission);
  } catch (const std::runtime_error& error) {
    table.fail("goal_lane", error.what());
  }
  return mission;
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
  scenario.network = map::load_network(scenario.network_file);
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

map::RouteGuide mission_guide(const Scenario& scenario) {
  const Mission& mission = scenario.mission;
  return {scenario.network, mission.edges, mission.goal_lane, mission.goal_s_m};
}

Scenario load_scenario(const std::filesystem::path& path, const std::string& flavour) {
  return load(path, flavour, true);
}

}  // namespace s4tp::scenario
