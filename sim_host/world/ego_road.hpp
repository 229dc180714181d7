#pragma once
/// What of an episode never changes, as the ego needs it: shared by the world and its branches.

#include "sim_host/world/nodes/vehicle.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/locator.hpp"

namespace s4tp::world {

struct EgoRoad {
  /// \param with_scenario  must outlive the road
  explicit EgoRoad(const Scenario& with_scenario)
      : scenario(with_scenario), guide(mission_guide(with_scenario)), locator(with_scenario.network, guide) {}
  EgoRoad(const EgoRoad&) = delete;  // the locator refers to the guide beside it
  EgoRoad& operator=(const EgoRoad&) = delete;

  const Scenario& scenario;
  RouteGuide guide;
  Locator locator;
};

/// The virtual car as one of the cars, at its place on the network.
[[nodiscard]] CarState ego_state(const Vehicle& vehicle, const LanePlace& place);

}  // namespace s4tp::world
