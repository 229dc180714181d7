#pragma once
/// [traffic] of a scenario file: route files, or flows and the drivers in them.

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/scenario/toml_table.hpp"

namespace s4tp::scenario {

/// Adds the traffic to a scenario whose network is loaded. \throws std::runtime_error naming file and key
void read_traffic(TomlTable traffic, Scenario& scenario);

}  // namespace s4tp::scenario
