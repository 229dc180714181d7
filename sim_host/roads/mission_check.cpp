#include "sim_host/roads/mission_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "sim_host/roads/road.hpp"

namespace s4tp::roads {
namespace {

using map::Lane;
using map::LaneId;
using map::Network;

constexpr double kPerChange_m = 20.0;
constexpr double kTightestRadius_m = 5.5;
constexpr double kCar_m = 5.0;
constexpr double kRounding_m = 0.5;  ///< by which netconvert may cut an arm shorter than drawn
constexpr double kFreeShare = 0.5;

const Lane& lane_at(const Network& network, LaneId lane) {
  return network.lanes[static_cast<std::size_t>(lane)];
}

/// Lanes of the same edge that `lanes` and at most `changes` lane changes lead to.
std::set<LaneId> spread(const Network& network, std::set<LaneId> lanes, int changes) {
  for (int i = 0; i < changes; ++i) {
    for (const LaneId lane : std::set<LaneId>(lanes)) {
      for (const LaneId beside : {lane_at(network, lane).left, lane_at(network, lane).right}) {
        if (beside != map::kNoLane) {
          lanes.insert(beside);
        }
      }
    }
  }
  return lanes;
}

/// Where `lanes` lead on to on an edge, through the junction's own lanes.
std::set<LaneId> followed(const Network& network, const std::set<LaneId>& lanes, const std::string& edge) {
  std::set<LaneId> reached;
  std::vector<LaneId> open(lanes.begin(), lanes.end());
  while (!open.empty()) {
    const LaneId lane = open.back();
    open.pop_back();
    for (const LaneId next : lane_at(network, lane).successors) {
      if (lane_at(network, next).in_junction) {
        open.push_back(next);
      } else if (lane_at(network, next).edge == edge) {
        reached.insert(next);
      }
    }
  }
  return reached;
}

bool changes_fit(const scenario::Scenario& scenario) {
  const scenario::Mission& mission = scenario.mission;
  const Network& network = scenario.network;
  std::set<LaneId> lanes{mission.start_lane};
  for (std::size_t i = 0; i < mission.edges.size(); ++i) {
    if (i > 0) {
      lanes = followed(network, lanes, mission.edges[i]);
    }
    const LaneId any = network.lanes_of(mission.edges[i]).front();
    const double end_m =
        i + 1 == mission.edges.size() ? mission.goal_s_m : lane_at(network, any).centre.length_m();
    const double room_m = end_m - (i == 0 ? mission.start_s_m : 0.0);
    lanes = spread(network, lanes, static_cast<int>(std::max(0.0, room_m) / kPerChange_m));
  }
  return lanes.contains(mission.goal_lane);
}

/// Over any length of a car a lane may turn as much as an arc of the tightest radius does.
bool is_tight(const Lane& lane) {
  for (double s_m = -kCar_m; s_m < lane.centre.length_m(); s_m += 0.5) {
    const double turned_rad = std::remainder(
        lane.centre.at(s_m + kCar_m).heading_rad - lane.centre.at(s_m).heading_rad, 2.0 * M_PI);
    if (std::abs(turned_rad) > kCar_m / kTightestRadius_m) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string obstacle_of(const scenario::Scenario& scenario) {
  const scenario::Mission& mission = scenario.mission;
  const Network& network = scenario.network;
  for (const LaneId lane : {mission.start_lane, mission.goal_lane}) {
    if (lane_at(network, lane).centre.length_m() < kShortestArm_m - kRounding_m) {
      return "an arm shorter than 25 m";
    }
  }
  const auto is_short = [](const Lane& lane) { return !lane.in_junction && lane.centre.length_m() < kCar_m; };
  if (std::any_of(network.lanes.begin(), network.lanes.end(), is_short)) {
    return "an edge shorter than a car";
  }
  if (!changes_fit(scenario)) {
    return "no room for its lane changes";
  }
  const map::RouteGuide guide(network, mission.edges, mission.goal_lane, mission.goal_s_m);
  for (std::size_t i = 0; i < network.lanes.size(); ++i) {
    if (guide.advice(static_cast<LaneId>(i)).on_route && is_tight(network.lanes[i])) {
      return "a corner tighter than the car";
    }
  }
  const double way_m = guide.advice(mission.start_lane).goal_distance_m - mission.start_s_m;
  if (way_m / lane_at(network, mission.start_lane).speed_limit_mps > kFreeShare * mission.time_limit_s) {
    return "too long for its time";
  }
  return {};
}

}  // namespace s4tp::roads
