#pragma once
/// Score of a candidate: a weighted sum, lower is better (method.md 4.7). No lexicographic rule.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/planner/explanation.hpp"
#include "algo/planner/lane_cost_to_go.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::planner {

/// The gap to drive for of the lane beside that we had rather be in, if driving on as we do there is one.
[[nodiscard]] trajectory::MergeTarget merge_target_of(const scene::Scene& scene,
                                                      const LaneCostToGo& cost_to_go,
                                                      const Parameters& parameters);

/// All terms but risk. From the lane we are in, one we had rather be in also asks how soon the end leads into
/// a gap there: a driver who has to merge looks for a gap before signalling. \param path  index of the ego
/// path the trajectory follows \param line  of that path: the speeds that may be driven there \param start_s_m  of the
/// trajectory's start, along the path \param leaves  the manoeuvre in force: starting a lane change has its price, and so
/// has dropping one \param careful  degraded driving: the speed wanted is lower \param work  what it took is added [WorkMeter's
/// units]
[[nodiscard]] CostBreakdown score_motion(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path,
                                         const trajectory::ReferenceLine& line, float start_s_m,
                                         const Trajectory& trajectory, bool leaves, bool careful,
                                         const Parameters& parameters, int& work);

}  // namespace s4tp::planner
