#include "sim_host/roads/scenario_toml.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim_host/world/scenario/format.hpp"

namespace s4tp::roads {
namespace {

using map::Lane;
using map::LaneId;
using scenario::format;

constexpr double kFirstStart_m = 5.0;
constexpr double kLatestStart_m = 15.0;
constexpr double kHalfCar_m = 2.5;
constexpr double kComfort_mps2 = 2.0;

/// A way as streams: one for each lane that leads on without a change.
std::vector<scenario::TrafficRoute> streams_of(const scenario::TrafficRoute& way,
                                               const map::Network& network) {
  if (way.start_lane >= 0) {
    return {way};
  }
  std::vector<scenario::TrafficRoute> streams;
  const map::RouteGuide guide(network, way.edges, map::kNoLane, 0.0);
  for (const LaneId lane : network.lanes_of(way.edges.front())) {
    if (guide.advice(lane).changes_needed == 0) {
      streams.push_back({way.edges, network.lanes[static_cast<std::size_t>(lane)].index, way.end_lane});
    }
  }
  return streams;
}

std::string flow_toml(const Streams& streams, const map::Network& network) {
  std::vector<scenario::TrafficRoute> all;
  for (const scenario::TrafficRoute& way : streams.ways) {
    for (const scenario::TrafficRoute& stream : streams_of(way, network)) {
      all.push_back(stream);
    }
  }
  const int count = static_cast<int>(all.size());
  const int low = streams.choose_high == 0 ? count : std::min(streams.choose_low, count);
  const int high = streams.choose_high == 0 ? count : std::min(streams.choose_high, count);
  std::string toml = format(
      "{ choose = [%d, %d], vehicles_per_minute = [%.1f, %.1f], begin_s = [0, 3], spacing = \"random\", ",
      low, high, streams.vehicles_per_minute.low, streams.vehicles_per_minute.high);
  if (!streams.driver.empty()) {
    toml += "driver = { " + streams.driver + " }, ";
  }
  toml += "routes = [\n";
  for (const scenario::TrafficRoute& stream : all) {
    toml += "  { edges = [";
    for (std::size_t i = 0; i < stream.edges.size(); ++i) {
      toml += (i > 0 ? ", \"" : "\"") + stream.edges[i] + '"';
    }
    toml += format("], start_lane = %d, end_lane = %d },\n", stream.start_lane, stream.end_lane);
  }
  return toml + "] }";
}

std::string traffic_toml(const RoadTraffic& traffic, const map::Network& network) {
  std::string toml;
  if (!traffic.mix.empty()) {
    toml += "mix = " + traffic.mix + '\n';
  }
  if (!traffic.driver.empty()) {
    toml += "driver = { " + traffic.driver + " }\n";
  }
  toml += "flow = [";
  for (std::size_t i = 0; i < traffic.streams.size(); ++i) {
    toml += (i > 0 ? ", " : "") + flow_toml(traffic.streams[i], network);
  }
  return toml + "]\n";
}

std::string mission_toml(const RoadMission& mission, const map::Network& network) {
  const LaneId id = network.lane_of(mission.start_edge, mission.start_lane);
  if (id == map::kNoLane) {
    throw std::runtime_error("no lane to start in");
  }
  const Lane& lane = network.lanes[static_cast<std::size_t>(id)];
  const double room_m =
      std::clamp(lane.centre.length_m() - kShortestArm_m, 0.0, kLatestStart_m - kFirstStart_m);
  const double start_m = kFirstStart_m + mission.start_share * room_m;
  // Who has to yield at the lane's end can: with comfort, from where the bumper is at entry.
  const double to_line_m = std::max(0.0, lane.centre.length_m() - start_m - kHalfCar_m);
  const double speed_mps = std::min(lane.speed_limit_mps, std::sqrt(2.0 * kComfort_mps2 * to_line_m));
  return format(
      "[mission]\nstart_lane = \"%s_%d\"\nstart_pos_m = %.1f\ngoal_lane = \"%s_%d\"\ngoal_pos_m = -1.0\n"
      "entry_time_s = %.1f\ntime_limit_s = 80.0\nentry_speed_mps = %.1f\n",
      mission.start_edge.c_str(), mission.start_lane, start_m, mission.goal_edge.c_str(), mission.goal_lane,
      mission.entry_time_s, mission.speed_share * speed_mps);
}

}  // namespace

std::string scenario_toml(const Road& road, const map::Network& network, const std::string& family) {
  return "# Drawn by ./s4tp roads, family " + family + ".\n[network]\nfile = \"network.net.xml\"\n\n" +
         mission_toml(road.mission, network) + "\n[traffic]\n" + traffic_toml(road.smarts, network) +
         "\n[flavour.social.traffic]\n" + traffic_toml(road.social, network);
}

}  // namespace s4tp::roads
