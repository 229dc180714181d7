#pragma once
/// Who wants to enter the network, where and when: drawn beforehand, so nothing the ego does changes it.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/scenario/traffic_demand.hpp"
#include "sim_host/world/traffic/random.hpp"
#include "sim_host/world/traffic/traffic_driver.hpp"

namespace s4tp::traffic {

/// A route that flows in this episode.
struct FlowRoute {
  map::RouteGuide guide;
  std::string last_edge;
  scenario::TrafficRoute route;
};

struct Departure {
  double time_s = 0.0;
  std::size_t way = 0;  ///< index
  map::LaneId lane = map::kNoLane;
  Driver driver;
  double length_m = 5.0;
  double width_m = 1.8;
  double s_m = -1.0;                                           ///< of the box centre; < 0: the lane's start
  double speed_mps = std::numeric_limits<double>::infinity();  ///< no more than that, and than is safe
};

/// Traffic time until which the streams of a scenario are drawn: longer than its episodes last.
inline constexpr double kDrawnUntil_s = 240.0;

struct FlowPlan {
  std::vector<FlowRoute> ways;
  std::vector<Departure> departures;  ///< by time
};

/// WORLD-020 Draws which routes of each group flow, how densely, and every driver; the same seed gives the
/// same plan. \param until_s  traffic time after which nobody wants to enter
[[nodiscard]] FlowPlan draw_flows(const map::Network& network, const std::vector<scenario::FlowGroup>& groups,
                                  double until_s, Random& random);

/// The same from a route file: SUMO's times, and of what it leaves to chance a draw. Where SUMO looks for
/// room ("free", "last") a lane is drawn and the car waits at its start.
[[nodiscard]] FlowPlan draw_demand(const map::Network& network, const scenario::Demand& demand,
                                   double until_s, Random& random);

}  // namespace s4tp::traffic
