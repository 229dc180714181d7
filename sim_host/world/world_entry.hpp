#pragma once
/// How an episode begins: which draw of the traffic, whom the ego's entry takes off the road, and what is
/// shown before it (WORLD-032, see World).

#include <memory>
#include <vector>

#include "sim_host/world/traffic/locator.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::world {

struct EnteredTraffic {
  std::unique_ptr<traffic::TrafficEngine> traffic;       ///< at entry
  std::vector<std::vector<traffic::CarState>> pre_roll;  ///< who is shown in each of its ticks
  int redrawn = 0;  ///< draws in which the ego would have been touched at once
};

/// \param scenario  must outlive the traffic
[[nodiscard]] EnteredTraffic draw_entry(const scenario::Scenario& scenario, const WorldOptions& options,
                                        const traffic::Locator& locator);

/// The ego under the world's own control: along the start lane at entry speed, straight before its start. WORLD-038 The ego
/// points and turns as a car does that goes along the line there: what it reports of its motion agrees with its poses.
/// \param time_s  since entry
[[nodiscard]] traffic::CarState ego_at_entry(const scenario::Scenario& scenario, double time_s);

}  // namespace s4tp::world
