#include "sim_host/world/traffic/traffic_flow.hpp"

#include <algorithm>
#include <numeric>

namespace s4tp::traffic {
namespace {

using map::LaneId;
using scenario::DepartWish;

map::RouteGuide guide_for(const map::Network& network, const scenario::TrafficRoute& route) {
  const LaneId goal = network.lane_of(route.edges.back(), route.end_lane);
  const LaneId any = goal == map::kNoLane ? network.lanes_of(route.edges.back()).at(0) : goal;
  return map::RouteGuide(network, route.edges, goal,
                         network.lanes[static_cast<std::size_t>(any)].centre.length_m());
}

/// Index by weight; a single one costs no draw.
std::size_t draw_index(const std::vector<double>& weights, Random& random) {
  if (weights.size() == 1) {
    return 0;
  }
  double left = random.uniform(0.0, std::accumulate(weights.begin(), weights.end(), 0.0));
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    left -= weights[i];
    if (left < 0.0) {
      return i;
    }
  }
  return weights.size() - 1;
}

const scenario::DriverModel& one_of(const std::vector<scenario::DriverModel>& drivers, Random& random) {
  std::vector<double> weights;
  for (const scenario::DriverModel& driver : drivers) {
    weights.push_back(driver.weight);
  }
  return drivers[draw_index(weights, random)];
}

Departure departure_of(double time_s, std::size_t way, LaneId lane, const scenario::DriverModel& model,
                       Random& random) {
  Departure departure{time_s, way, lane, draw_driver(model, random)};
  departure.length_m = model.length_m;
  departure.width_m = model.width_m;
  return departure;
}

void sort_by_time(FlowPlan& plan) {
  std::stable_sort(plan.departures.begin(), plan.departures.end(),
                   [](const Departure& a, const Departure& b) { return a.time_s < b.time_s; });
}

/// When the cars of a flow want to enter.
std::vector<double> times_of(const scenario::DemandFlow& flow, double until_s, Random& random) {
  std::vector<double> times;
  const double end_s = std::min(flow.end_s, until_s);
  const bool exponential = flow.spacing == scenario::DemandFlow::Spacing::kExponential;
  double time_s = flow.begin_s + (exponential ? random.exponential(flow.period_s) : 0.0);
  while (time_s < end_s && times.size() < static_cast<std::size_t>(flow.number)) {
    if (flow.spacing != scenario::DemandFlow::Spacing::kPerSecond || random.uniform() < flow.probability) {
      times.push_back(time_s);
    }
    time_s += exponential                                                 ? random.exponential(flow.period_s)
              : flow.spacing == scenario::DemandFlow::Spacing::kPerSecond ? 1.0
                                                                          : flow.period_s;
  }
  return times;
}

LaneId lane_for(const map::Network& network, const scenario::TrafficRoute& route,
                const map::RouteGuide& guide, const DepartWish& wish, Random& random) {
  if (wish.lane == DepartWish::Lane::kNumber) {
    return network.lane_of(route.edges.front(), wish.lane_number);
  }
  std::vector<LaneId> lanes = network.lanes_of(route.edges.front());
  if (wish.lane == DepartWish::Lane::kFirst) {
    return lanes.front();
  }
  if (wish.lane == DepartWish::Lane::kBest) {
    const auto leads = [&](LaneId lane) { return guide.advice(lane).changes_needed == 0; };
    if (std::any_of(lanes.begin(), lanes.end(), leads)) {
      std::erase_if(lanes, [&](LaneId lane) { return !leads(lane); });
    }
  }
  return lanes[static_cast<std::size_t>(random.integer(0, static_cast<int>(lanes.size()) - 1))];
}

/// Of the box centre; < 0: the lane's start.
double start_of(const map::Lane& lane, const DepartWish& wish, double car_m, Random& random) {
  const double length_m = lane.centre.length_m();
  double front_m = wish.position_m < 0.0 ? length_m + wish.position_m : wish.position_m;
  if (wish.position == DepartWish::Position::kBase) {
    return -1.0;
  }
  if (wish.position == DepartWish::Position::kRandom) {
    front_m = random.uniform(car_m, std::max(car_m, length_m));
  }
  return std::clamp(front_m - 0.5 * car_m, 0.0, length_m);
}

}  // namespace

FlowPlan draw_flows(const map::Network& network, const std::vector<scenario::FlowGroup>& groups,
                    double until_s, Random& random) {
  FlowPlan plan;
  for (const scenario::FlowGroup& group : groups) {
    std::vector<scenario::TrafficRoute> pool = group.routes;
    const int most = static_cast<int>(pool.size());
    const int chosen = std::min(most, random.integer(std::min(group.choose_low, most), group.choose_high));
    for (int flow = 0; flow < chosen; ++flow) {
      std::swap(pool[static_cast<std::size_t>(flow)],
                pool[static_cast<std::size_t>(random.integer(flow, most - 1))]);
      const scenario::TrafficRoute& route = pool[static_cast<std::size_t>(flow)];
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
        plan.departures.push_back(departure_of(time_s, way, lane, one_of(group.drivers, random), random));
        time_s += group.random_spacing ? random.exponential(spacing_s) : spacing_s;
      }
    }
  }
  sort_by_time(plan);
  return plan;
}

FlowPlan draw_demand(const map::Network& network, const scenario::Demand& demand, double until_s,
                     Random& random) {
  FlowPlan plan;
  for (const scenario::TrafficRoute& route : demand.routes) {
    plan.ways.push_back({guide_for(network, route), route.edges.back(), route});
  }
  for (const scenario::DemandFlow& flow : demand.flows) {
    for (const double time_s : times_of(flow, until_s, random)) {
      const std::size_t way = flow.routes[draw_index(flow.route_weights, random)];
      const scenario::DriverModel& model = one_of(flow.drivers, random);
      const LaneId lane = lane_for(network, demand.routes[way], plan.ways[way].guide, flow.depart, random);
      Departure departure = departure_of(std::max(0.0, time_s), way, lane, model, random);
      const map::Lane& on = network.lanes[static_cast<std::size_t>(lane)];
      departure.s_m = start_of(on, flow.depart, model.length_m, random);
      if (flow.depart.speed == DepartWish::Speed::kNumber) {
        departure.speed_mps = flow.depart.speed_mps;
      } else if (flow.depart.speed == DepartWish::Speed::kRandom) {
        departure.speed_mps = random.uniform(0.0, std::min(on.speed_limit_mps, model.max_speed_mps));
      }
      plan.departures.push_back(departure);
    }
  }
  sort_by_time(plan);
  return plan;
}

}  // namespace s4tp::traffic
