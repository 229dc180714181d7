#include "sim_host/recording/same_start.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "sim_host/recording/as_seen.hpp"
#include "sim_host/recording/rerun.hpp"
#include "sim_host/recording/ticks.hpp"
#include "sim_host/world/ego_road.hpp"
#include "sim_host/world/engine_factory.hpp"
#include "sim_host/world/map/lane_of.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::recording {
namespace {

namespace fs = std::filesystem;
using map::Lane;
using map::LaneId;
using map::Network;

constexpr double kTick_s = 0.01;

/// A position along a lane's shape as SUMO counts it.
double sumo_position_m(const Lane& lane, double s_m) {
  const double shape_m = lane.centre.length_m();
  const double on_lane_m = std::clamp(s_m, 0.0, shape_m);
  return lane.sumo_length_m > 0.0 ? on_lane_m * lane.sumo_length_m / shape_m : on_lane_m;
}

double turn_rad(const Lane& lane) {
  const double turn = lane.centre.at(lane.centre.length_m()).heading_rad - lane.centre.at(0.0).heading_rad;
  return std::abs(std::remainder(turn, 2.0 * std::numbers::pi));
}

/// Straight on from a lane to where the network ends, or an edge would come again.
std::string straight_on(const Network& network, LaneId lane) {
  std::string edges = lane_of(network, lane).edge;
  std::set<std::string> passed{edges};
  while (!lane_of(network, lane).successors.empty()) {
    const std::vector<LaneId>& successors = lane_of(network, lane).successors;
    lane = *std::min_element(successors.begin(), successors.end(), [&](LaneId a, LaneId b) {
      return turn_rad(lane_of(network, a)) < turn_rad(lane_of(network, b));
    });
    const Lane& next = lane_of(network, lane);
    if (next.in_junction) continue;
    if (!passed.insert(next.edge).second) break;
    edges += ' ' + next.edge;
  }
  return edges;
}

/// What was on the bus at an instant, in the network's coordinates.
struct Instant {
  traffic::CarState ego;
  std::vector<traffic::CarState> others;
};

Instant instant_of(const fs::path& file, const DriveNote& note, double start_s) {
  TickReader reader(file);
  EcuRerun ecu(note, nullptr);
  Agreement ignored;
  wire::MapOrigin origin;
  RecordedTick tick;
  const long wanted = std::lround(start_s / kTick_s);
  long ticks = 0;
  for (; ticks < wanted && reader.next(tick); ++ticks) {
    ecu.play(tick, ignored);
    for (const wire::Frame& frame : tick.from_world) (void)wire::decode(frame, origin);
  }
  const bool known = ticks == wanted && ecu.core().inputs().ego_known();
  if (!known) {
    throw std::runtime_error(file.string() + ": holds no pose of ours " + std::to_string(start_s) +
                             " s after its beginning; --cut takes a moment 10 s after one it holds");
  }
  const traffic::Snapshot now = snapshot_of(ecu.core(), note.parameters);
  Instant instant{now.ego, now.others};
  const auto moved = [&](traffic::CarState& car) {
    car.centre.x += static_cast<double>(origin.x_m);
    car.centre.y += static_cast<double>(origin.y_m);
  };
  moved(instant.ego);
  for (traffic::CarState& car : instant.others) moved(car);
  return instant;
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

StartMade write_same_start(const fs::path& file, const DriveNote& note, double start_s,
                           const scenario::Scenario& roads, const fs::path& folder) {
  const Instant instant = instant_of(file, note, start_s);
  const Network& network = roads.network;
  const world::EgoRoad road(roads);
  const auto place_of = [&](const traffic::CarState& car) {
    return road.locator.locate(car.centre, car.heading_rad, map::kNoLane);
  };
  const auto on_a_lane = [&](const traffic::LanePlace& place) {
    return place.inside && place.lane != map::kNoLane && !lane_of(network, place.lane).in_junction;
  };
  const traffic::LanePlace self = place_of(instant.ego);
  if (!on_a_lane(self)) {
    throw std::runtime_error(file.string() + ": 10 s before that moment we are inside a junction of " +
                             roads.network_file.string() + ", or on none of its lanes; name another moment");
  }

  StartMade made;
  struct Placed {
    traffic::CarState car;
    traffic::LanePlace at;
  };
  std::vector<Placed> placed;
  for (const traffic::CarState& car : instant.others) {
    ++made.told;
    const traffic::LanePlace at = place_of(car);
    if (on_a_lane(at)) placed.push_back({car, at});
    if (!on_a_lane(at)) ++made.left_out;
  }
  // Whoever is ahead comes first, so that those behind find it there.
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.at.s_m > b.at.s_m; });

  std::string routes = "<routes>\n";
  for (const auto& [car, at] : placed) {
    const Lane& lane = lane_of(network, at.lane);
    const std::string id = '"' + std::to_string(car.id) + '"';
    const double front_m = sumo_position_m(lane, at.s_m + 0.5 * car.length_m);
    routes += " <vType id=" + id + " length=\"" + std::to_string(car.length_m) + "\" width=\"" +
              std::to_string(car.width_m) + "\"/>\n <vehicle id=" + id + " type=" + id +
              " depart=\"0\" departLane=\"" + std::to_string(lane.index) + "\" departPos=\"" +
              std::to_string(front_m) + "\" departSpeed=\"" + std::to_string(car.speed_mps) +
              "\"><route edges=\"" + straight_on(network, at.lane) + "\"/></vehicle>\n";
  }
  routes += "</routes>\n";

  const scenario::Mission& mission = roads.mission;
  const Lane& start = lane_of(network, self.lane);
  const Lane& goal = lane_of(network, mission.goal_lane);
  fs::create_directories(folder);
  fs::copy_file(roads.network_file, folder / "network.net.xml");
  write(folder / "traffic.rou.xml", routes);
  write(folder / "scenario.toml",
        "# The start of " + std::to_string(start_s) +
            " s of a log, with default drivers (docs/recording.md).\n" +
            "[network]\nfile = \"network.net.xml\"\n[mission]\nstart_lane = \"" + start.name +
            "\"\nstart_pos_m = " + std::to_string(sumo_position_m(start, self.s_m)) + "\ngoal_lane = \"" +
            goal.name + "\"\ngoal_pos_m = " + std::to_string(sumo_position_m(goal, mission.goal_s_m)) +
            "\nentry_time_s = 0.0\ntime_limit_s = " + std::to_string(mission.time_limit_s) +
            "\nentry_speed_mps = " + std::to_string(instant.ego.speed_mps) +
            "\n[traffic]\nroutes = [\"traffic.rou.xml\"]\n");

  try {
    const scenario::Scenario scenario = scenario::load_scenario(folder);
    const auto engine = world::make_engine(scenario, {});
    for (std::size_t i = 0; i < placed.size(); ++i) engine->step(nullptr);  // one a step comes into a lane
    made.there = static_cast<int>(engine->cars().size());
  } catch (...) {  // from there no way leads to the goal
    fs::remove_all(folder);
    throw;
  }
  return made;
}

}  // namespace s4tp::recording
