#include "sim_host/world/map/find_route.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <set>
#include <stdexcept>
#include <utility>

namespace s4tp::map {
namespace {

constexpr double kChange_m = 20.0;

struct Search {
  std::vector<double> distance_m;  ///< to the lane's start; infinity: no way there
  std::vector<LaneId> before;      ///< the lane before it on the shortest way
};

Search search_from(const Network& network, const std::vector<LaneId>& starts) {
  using Open = std::pair<double, LaneId>;
  Search search{std::vector<double>(network.lanes.size(), std::numeric_limits<double>::infinity()),
                std::vector<LaneId>(network.lanes.size(), kNoLane)};
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (const LaneId start : starts) {
    search.distance_m[static_cast<std::size_t>(start)] = 0.0;
    open.emplace(0.0, start);
  }
  while (!open.empty()) {
    const auto [here_m, id] = open.top();
    open.pop();
    if (here_m > search.distance_m[static_cast<std::size_t>(id)]) {
      continue;
    }
    const auto reach = [&, at_m = here_m, at = id](LaneId next, double step_m) {
      if (next != kNoLane && at_m + step_m < search.distance_m[static_cast<std::size_t>(next)]) {
        search.distance_m[static_cast<std::size_t>(next)] = at_m + step_m;
        search.before[static_cast<std::size_t>(next)] = at;
        open.emplace(at_m + step_m, next);
      }
    };
    const Lane& lane = network.lanes[static_cast<std::size_t>(id)];
    for (const LaneId next : lane.successors) {
      reach(next, lane.centre.length_m());
    }
    reach(lane.left, kChange_m);
    reach(lane.right, kChange_m);
  }
  return search;
}

/// Edges of the way that ends in `to`. \return empty: none
std::vector<std::string> edges_to(const Network& network, const Search& search, LaneId to) {
  std::vector<std::string> edges;
  if (search.distance_m[static_cast<std::size_t>(to)] == std::numeric_limits<double>::infinity()) {
    return edges;
  }
  for (LaneId at = to; at != kNoLane; at = search.before[static_cast<std::size_t>(at)]) {
    const Lane& lane = network.lanes[static_cast<std::size_t>(at)];
    if (!lane.in_junction && (edges.empty() || edges.back() != lane.edge)) {
      edges.push_back(lane.edge);
    }
  }
  std::reverse(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<std::string> find_route(const Network& network, LaneId from, double from_s_m, LaneId to,
                                    double to_s_m) {
  const Lane& start = network.lanes.at(static_cast<std::size_t>(from));
  const Lane& goal = network.lanes.at(static_cast<std::size_t>(to));
  const auto no_way = [&](const std::string& why) {
    return std::runtime_error("no way for a car leads from lane \"" + start.name + "\" to lane \"" +
                              goal.name + "\": " + why);
  };
  if (start.edge == goal.edge && to_s_m <= from_s_m) {
    throw no_way("the goal lies behind the start on the same edge");
  }
  const std::vector<std::string> edges = edges_to(network, search_from(network, {from}), to);
  if (edges.empty()) {
    throw no_way("the connections and lane changes that cars are allowed do not lead there");
  }
  std::set<std::string> seen;
  for (const std::string& edge : edges) {
    if (!seen.insert(edge).second) {
      throw no_way("it would pass edge \"" + edge + "\" twice");
    }
  }
  return edges;
}

std::vector<std::string> find_route(const Network& network, const std::string& from_edge,
                                    const std::string& to_edge) {
  const std::vector<LaneId> starts = network.lanes_of(from_edge);
  const std::vector<LaneId> ends = network.lanes_of(to_edge);
  for (const auto& [lanes, edge] : {std::pair(&starts, &from_edge), std::pair(&ends, &to_edge)}) {
    if (lanes->empty()) {
      throw std::runtime_error("the network has no edge \"" + *edge + "\" that cars may use");
    }
  }
  const Search search = search_from(network, starts);
  const LaneId nearest = *std::min_element(ends.begin(), ends.end(), [&](LaneId a, LaneId b) {
    return search.distance_m[static_cast<std::size_t>(a)] < search.distance_m[static_cast<std::size_t>(b)];
  });
  std::vector<std::string> edges = edges_to(network, search, nearest);
  if (edges.empty()) {
    throw std::runtime_error("no way for a car leads from edge \"" + from_edge + "\" to edge \"" + to_edge +
                             "\"");
  }
  return edges;
}

}  // namespace s4tp::map
