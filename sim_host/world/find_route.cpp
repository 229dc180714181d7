#include "sim_host/world/find_route.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace s4tp::world {
namespace {

constexpr double kChange_m = 20.0;

/// For each lane the one before it on the shortest way, kNoLane where there is none.
std::vector<LaneId> shortest_ways(const Network& network, LaneId from) {
  using Open = std::pair<double, LaneId>;
  std::vector<double> distance_m(network.lanes.size(), std::numeric_limits<double>::infinity());
  std::vector<LaneId> before(network.lanes.size(), kNoLane);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  distance_m[static_cast<std::size_t>(from)] = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [here_m, id] = open.top();
    open.pop();
    if (here_m > distance_m[static_cast<std::size_t>(id)]) {
      continue;
    }
    const auto reach = [&, at_m = here_m, at = id](LaneId next, double step_m) {
      if (next != kNoLane && at_m + step_m < distance_m[static_cast<std::size_t>(next)]) {
        distance_m[static_cast<std::size_t>(next)] = at_m + step_m;
        before[static_cast<std::size_t>(next)] = at;
        open.emplace(at_m + step_m, next);
      }
    };
    const NetworkLane& lane = network.lanes[static_cast<std::size_t>(id)];
    for (const LaneId next : lane.successors) {
      reach(next, lane.centre.length_m());
    }
    reach(lane.left, kChange_m);
    reach(lane.right, kChange_m);
  }
  return before;
}

}  // namespace

std::vector<std::string> find_route(const Network& network, LaneId from, double from_s_m, LaneId to,
                                    double to_s_m) {
  const NetworkLane& start = network.lanes.at(static_cast<std::size_t>(from));
  const NetworkLane& goal = network.lanes.at(static_cast<std::size_t>(to));
  const auto no_way = [&](const std::string& why) {
    return std::runtime_error("no way for a car leads from lane \"" + start.name + "\" to lane \"" +
                              goal.name + "\": " + why);
  };
  if (start.edge == goal.edge && to_s_m <= from_s_m) {
    throw no_way("the goal lies behind the start on the same edge");
  }
  const std::vector<LaneId> before = shortest_ways(network, from);
  std::vector<std::string> edges;
  for (LaneId at = to; at != kNoLane; at = at == from ? kNoLane : before[static_cast<std::size_t>(at)]) {
    const NetworkLane& lane = network.lanes[static_cast<std::size_t>(at)];
    if (!lane.in_junction && (edges.empty() || edges.back() != lane.edge)) {
      if (std::find(edges.begin(), edges.end(), lane.edge) != edges.end()) {
        throw no_way("it would pass edge \"" + lane.edge + "\" twice");
      }
      edges.push_back(lane.edge);
    }
    if (at != from && before[static_cast<std::size_t>(at)] == kNoLane) {
      throw no_way("the connections and lane changes that cars are allowed do not lead there");
    }
  }
  std::reverse(edges.begin(), edges.end());
  return edges;
}

}  // namespace s4tp::world
