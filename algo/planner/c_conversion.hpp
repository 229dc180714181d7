#pragma once
/// Plain structs of s4tp.h into the core's types and back. Every copy in looks at what a caller in C may get
/// wrong; on false the target's content is of no use.

#include "algo/api/s4tp.h"
#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/world_state.hpp"
#include "algo/planner/explanation.hpp"

namespace s4tp::planner {

[[nodiscard]] Parameters core_parameters(const s4tp_parameters& from);
[[nodiscard]] EgoState core_ego(const s4tp_ego& from);
/// \return false when the list is too long; the vehicles themselves are looked at by the planner
[[nodiscard]] bool copy_tracks(const s4tp_tracks& from, TrackList& to);
/// Lengths are computed. \return false when anything in the map is not as s4tp.h says
[[nodiscard]] bool copy_map(const s4tp_lane_map& from, LaneMap& to);
/// \return false when it cannot have been written by us
[[nodiscard]] bool copy_plan(const s4tp_plan& from, Plan& to);

[[nodiscard]] s4tp_plan_point c_point(const TrajectoryPoint& from);
void copy_back(const Plan& from, s4tp_plan& to);
void copy_back(const Explanation& from, s4tp_explanation& to);

}  // namespace s4tp::planner
