#pragma once
/// Score of a candidate: a weighted sum, lower is better (METHOD 4.4). No lexicographic rule.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/planner/explanation.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// All terms but risk.
/// \param path        index of the ego path the trajectory follows
/// \param keeps_plan  it continues the running plan's lateral motion: no price for a lane change
/// \param careful     degraded driving: the speed wanted is lower
[[nodiscard]] CostBreakdown score_motion(const Scene& scene, int path, const Trajectory& trajectory,
                                         bool keeps_plan, bool careful, const Parameters& parameters);

}  // namespace s4tp
