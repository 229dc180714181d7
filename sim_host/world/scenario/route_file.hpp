#pragma once
/// Traffic as SUMO's route files (.rou.xml) describe it, for the built-in drivers.
/// https://sumo.dlr.de/docs/Definition_of_Vehicles%2C_Vehicle_Types%2C_and_Routes.html

#include <filesystem>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/scenario/traffic_demand.hpp"

namespace s4tp::scenario {

/// Reads vehicles, trips (routed here), flows, vehicle types, routes and their distributions. Persons,
/// containers, stops, rail and ships are left out with a note; so are vehicles other than cars whose way cars
/// may not take. SCN-003 \throws std::runtime_error naming file, element and what was expected
[[nodiscard]] Demand load_demand(const std::filesystem::path& file, const map::Network& network);

}  // namespace s4tp::scenario
