#pragma once
/// Results by family of roads for a terminal.

#include <ostream>
#include <vector>

#include "sim_host/campaign/results.hpp"

namespace s4tp::campaign {

/// A line a family with its interval clustered by road, then drivers on the same episodes side by side.
void print_families(std::ostream& out, const std::vector<CellResult>& cells);

}  // namespace s4tp::campaign
