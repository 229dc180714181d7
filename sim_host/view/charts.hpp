#pragma once
/// Pictures of results, as SVG for a page; colours are the page's.

#include <string>
#include <vector>

#include "sim_host/campaign/results.hpp"

namespace s4tp::view {

using Cells = std::vector<const campaign::CellResult*>;

/// Scenario by scenario a line for each planner: success with its 95 % interval, and how time to goal and
/// smallest gap are distributed. Full marks: guarded, hollow ones: bare.
/// \param cells  that differ in planner, guard and scenario only
[[nodiscard]] std::string outcome_chart(const Cells& cells);

}  // namespace s4tp::view
