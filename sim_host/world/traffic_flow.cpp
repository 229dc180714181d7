#include "sim_host/world/traffic_flow.hpp"

#include <algorithm>

namespace s4tp::world {
namespace {

RouteGuide guide_for(const Network& network, const TrafficRoute& route) {
  const LaneId goal = network.lane_of(route.edges.back(), route.end_lane);
  const LaneId any = goal == kNoLane ? network.lanes_of(route.edges.back()).at(0) : goal;
  return RouteGuide(network, route.edges, goal,
                    network.lanes[static_cast<std::size_t>(any)].centre.length_m());
}

/// By weight; a single one costs no draw.
const DriverModel& one_of(const std::vector<DriverModel>& drivers, Random& random) {
  if (drivers.size() == 1) {
    return drivers.front();
  }
  double all = 0.0;
  for (const DriverModel& driver : drivers) {
    all += driver.weight;
  }
  double left = random.uniform(0.0, all);
  for (const DriverModel& driver : drivers) {
    left -= driver.weight;
    if (left < 0.0) {
      return driver;
    }
  }
  return drivers.back();
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
      plan.ways.push_back({guide_for(network, route), route.edges.back(), route});
      const double spacing_s =
          60.0 / random.uniform(group.vehicles_per_minute.low, group.vehicles_per_minute.high);
      double time_s = random.uniform(group.begin_s.low, group.begin_s.high);
      if (group.random_spacing) {
        time_s += random.exponential(spacing_s);
      }
      while (time_s < until_s) {
        const LaneId lane =
            route.start_lane >= 0
                ? network.lane_of(route.edges.front(), route.start_lane)
                : start.at(static_cast<std::size_t>(random.integer(0, static_cast<int>(start.size()) - 1)));
        plan.departures.push_back({time_s, way, lane, draw_driver(one_of(group.drivers, random), random)});
        time_s += group.random_spacing ? random.exponential(spacing_s) : spacing_s;
      }
    }
  }
  std::stable_sort(plan.departures.begin(), plan.departures.end(),
                   [](const Departure& a, const Departure& b) { return a.time_s < b.time_s; });
  return plan;
}

}  // namespace s4tp::world
