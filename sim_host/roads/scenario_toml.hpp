#pragma once
/// scenario.toml of a road (sim_host/scenarios/README.md).

#include <string>

#include "sim_host/roads/road.hpp"
#include "sim_host/world/map/network.hpp"

namespace s4tp::roads {

/// \param network  what netconvert made of it  \param family  for its first line
/// \throws std::runtime_error when a way does not lead through the network
[[nodiscard]] std::string scenario_toml(const Road& road, const map::Network& network,
                                        const std::string& family);

}  // namespace s4tp::roads
