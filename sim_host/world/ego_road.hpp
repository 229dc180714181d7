#pragma once
/// What of an episode never changes, as the ego needs it: shared by the world and its branches.

#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/locator.hpp"

namespace s4tp::world {

struct EgoRoad {
  /// \param with_scenario  must outlive the road
  explicit EgoRoad(const scenario::Scenario& with_scenario)
      : scenario(with_scenario),
        guide(scenario::mission_guide(with_scenario)),
        locator(with_scenario.network, guide) {}
  EgoRoad(const EgoRoad&) = delete;  // the locator refers to the guide beside it
  EgoRoad& operator=(const EgoRoad&) = delete;

  const scenario::Scenario& scenario;
  map::RouteGuide guide;
  traffic::Locator locator;
};

/// The virtual car as one of the cars, at its place on the network.
[[nodiscard]] traffic::CarState ego_state(const nodes::Vehicle& vehicle, const traffic::LanePlace& place);

}  // namespace s4tp::world
