#include "sim_host/world/traffic_flow.hpp"

#include <algorithm>

namespace s4tp::world {
namespace {

RouteGuide guide_for(const Network& network, const TrafficRoute& route) {
  const std::vector<LaneId> last = network.lanes_of(route.edges.back());
  LaneId goal = kNoLane;
  if (route.end_lane >= 0 && route.end_lane < static_cast<int>(last.size())) {
    goal = last[static_cast<std::size_t>(route.end_lane)];
  }
  const LaneId any = goal == kNoLane ? last.at(0) : goal;
  return RouteGuide(network, route.edges, goal,
                    network.lanes[static_cast<std::size_t>(any)].centre.length_m());
}

}  // namespace

FlowPlan draw_flows(const Network& network, const std::vector<FlowGroup>& groups, double until_s,
                    Random& random) {
  FlowPlan plan;
  for (const FlowGroup& group : groups) {
    std::vector<TrafficRoute> pool = group.routes;
    const int most = static_cast<int>(pool.size());
    const int chosen = std::min(most, random.integer(std::min(group.choose_low, most), group.choose_high));
    for (int flow = 0; flow < chosen; ++flow) {
      std::swap(pool[static_cast<std::size_t>(flow)],
                pool[static_cast<std::size_t>(random.integer(flow, most - 1))]);
      const TrafficRoute& route = pool[static_cast<std::size_t>(flow)];
      const std::vector<LaneId> start = network.lanes_of(route.edges.front());
      const std::size_t way = plan.ways.size();
      plan.ways.push_back({guide_for(network, route), route.edges.back()});
      const double spacing_s =
          60.0 / random.uniform(group.vehicles_per_minute.low, group.vehicles_per_minute.high);
      double time_s = random.uniform(group.begin_s.low, group.begin_s.high);
      if (group.random_spacing) {
        time_s += random.exponential(spacing_s);
      }
      while (time_s < until_s) {
        const int index =
            route.start_lane >= 0 ? route.start_lane : random.integer(0, static_cast<int>(start.size()) - 1);
        plan.departures.push_back(
            {time_s, way, start.at(static_cast<std::size_t>(index)), draw_driver(group.driver, random)});
        time_s += group.random_spacing ? random.exponential(spacing_s) : spacing_s;
      }
    }
  }
  std::stable_sort(plan.departures.begin(), plan.departures.end(),
                   [](const Departure& a, const Departure& b) { return a.time_s < b.time_s; });
  return plan;
}

}  // namespace s4tp::world
