#pragma once
/// What a motion leaves to be driven to the goal: the first of Predictive-Decision's features.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::baselines {

/// A goal that cannot be reached any more: worse than the least time to collision, less bad than a collision
/// (weights 5 and 10).
inline constexpr float kMissed = 8.0F;

/// Way to the goal not gained along `path`, of the longest possible: 0 at the limit, 1 at a standstill. A lane change
/// still due counts as the way that one takes at the limit (comfort.lane_change_s), and up to kMissed more where that
/// is not left for it: 15 m each, from a stop, or over the line before our lane ends.
[[nodiscard]] float goal_distance(const scene::Scene& scene, const scene::EgoPath& path,
                                  const Trajectory& trajectory, const Parameters& parameters);

}  // namespace s4tp::baselines
