#pragma once
/// Score of a candidate: a weighted sum, lower is better (METHOD 4.4). No lexicographic rule.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/planner/explanation.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// All terms but risk. Where the route asks for a lane change, the lane term also says how well the end fits
/// a gap in the lane beside: a driver who has to merge looks for his gap before he signals. \param keep_going
/// what the others do meanwhile \param path        index of the ego path the trajectory follows \param
/// keeps_plan  it continues the running plan's lateral motion: no price for a lane change \param careful
/// degraded driving: the speed wanted is lower
[[nodiscard]] CostBreakdown score_motion(const Scene& scene, const KinematicSet& keep_going, int path,
                                         const Trajectory& trajectory, bool keeps_plan, bool careful,
                                         const Parameters& parameters);

}  // namespace s4tp
