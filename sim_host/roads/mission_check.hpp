#pragma once
/// Whether a car can drive a mission at all, were nobody else there.

#include <string>

#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::roads {

/// Why no car could, or only one far beyond the ordinary; empty: it can. ROAD-003 asked for are lanes of 25 m
/// to start and to end in, and none shorter than a car (SUMO 1.15 gives up on one that has been placed
/// there), 20 m of road for each lane change that the way needs, corners of 5.5 m radius (the car turns
/// on 4.7 m), and a free drive of at most half of the time limit.
[[nodiscard]] std::string obstacle_of(const scenario::Scenario& scenario);

}  // namespace s4tp::roads
