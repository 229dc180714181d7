#pragma once
/// The minimum-risk manoeuvre: what is driven when nothing else passes. There is always one.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// Brakes to a stop along our lane (or the running plan's path, or the present curvature, whichever is
/// known), with safety.minimum_risk_braking, harder up to vehicle.braking_max when a leader demands it; an
/// ego already inside a conflict zone leaves it first when its way is free.
void minimum_risk(const Scene& scene, const TrajectoryPoint& start, const Plan& running,
                  std::uint32_t start_ms, const Parameters& parameters, Trajectory& trajectory);

}  // namespace s4tp
