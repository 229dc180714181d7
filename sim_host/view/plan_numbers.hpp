#pragma once
/// A plan's explanation for an engineer: costs of chosen and runner-up, rejections by reason, risk, RSS, work.

#include <string>

#include "sim_host/campaign/trace.hpp"

namespace s4tp::view {

/// Several lines, without a newline at the end.
[[nodiscard]] std::string in_numbers(const campaign::CycleTrace& cycle);

/// How many candidates of the cycle were rejected for that reason.
[[nodiscard]] int rejected(const planner::Explanation& explanation, trajectory::Rejection why);

[[nodiscard]] const char* name_of(scene::Manoeuvre manoeuvre);

}  // namespace s4tp::view
