#pragma once
/// Whether what a cycle is given can be: numbers, and within the ranges of any road vehicle.

#include "algo/planner/planner.hpp"

namespace s4tp::planner {

[[nodiscard]] bool is_valid(const EgoState& ego);

/// Whether a running plan is one of ours (CORE-014); of kind none it is.
[[nodiscard]] bool is_valid(const Plan& plan, const Parameters& parameters);

/// Of the input's times and tracks.
[[nodiscard]] bool are_others_valid(const PlannerInput& input);

}  // namespace s4tp::planner
