#include "sim_host/world/traffic/start_zone.hpp"

#include <algorithm>

namespace s4tp::traffic {
namespace {

constexpr double kClearHeadway_s = 1.5;

}  // namespace

void free_start_zone(const scenario::Scenario& scenario, double ego_length_m, TrafficEngine& engine) {
  const scenario::Mission& mission = scenario.mission;
  const double half_m = 0.5 * ego_length_m;
  const double limit_mps =
      scenario.network.lanes[static_cast<std::size_t>(mission.start_lane)].speed_limit_mps;
  engine.clear(mission.start_lane,
               mission.start_s_m - half_m - kClearHeadway_s * std::max(limit_mps, mission.start_speed_mps),
               mission.start_s_m + half_m + kClearHeadway_s * mission.start_speed_mps);
}

}  // namespace s4tp::traffic
