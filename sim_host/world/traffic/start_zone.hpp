#pragma once
/// The stretch of road around the ego's entry.

#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::traffic {

/// Takes everybody off it: who would be within 1.5 s of headway of the ego as it enters, ahead or behind.
void free_start_zone(const scenario::Scenario& scenario, double ego_length_m, TrafficEngine& engine);

}  // namespace s4tp::traffic
