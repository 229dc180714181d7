#pragma once
/// Terminal condition (METHOD 4.2): the end of a plan must be safe for ever, though the horizon is 3 s.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// For each conflict zone of the path not yet left at the trajectory's end: the end can still stop before it
/// at comfortable deceleration, or has left it, or leaves it with safety.zone_margin_s to spare before any
/// vehicle with right of way can reach it (at limit * safety.over_limit, accelerating). Also: the end can
/// stop before the lane path ends and behind the leader in its lane (leader braking b_max). \param path index
/// of the ego path the trajectory follows
[[nodiscard]] bool terminal_safe(const Scene& scene, int path, const Trajectory& trajectory,
                                 const Parameters& parameters);

/// Seconds until vehicle `agent`, free to accelerate, can reach `zone`'s part of its lane; 0 when inside,
/// a large number (1e3) when it cannot reach it or has left it.
[[nodiscard]] float earliest_arrival_s(const Scene& scene, int agent, const ConflictZone& zone,
                                       const Parameters& parameters);

}  // namespace s4tp
