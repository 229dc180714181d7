#pragma once
/// Our flows in SUMO's words: what its route files hold.

#include <string>
#include <vector>

#include "sim_host/world/traffic_flow.hpp"

namespace s4tp::world {

inline constexpr const char* kEgoName = "ego";  ///< of its vehicle, its type and its route

/// The ego's type and route: a car of our size, with SUMO's ordinary driver.
[[nodiscard]] std::string ego_definitions(const std::vector<std::string>& edges, double length_m,
                                          double width_m, const std::string& driver);

/// SUMO-002 Every departure of the plan as a vehicle of its own type, drawn by us, not by SUMO: the same
/// drivers at the same times as in the built-in traffic.
[[nodiscard]] std::string flow_definitions(const Network& network, const FlowPlan& plan);

/// A file of both parts.
[[nodiscard]] std::string routes_file(const std::string& definitions);

}  // namespace s4tp::world
