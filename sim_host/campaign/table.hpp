#pragma once
/// Results for a terminal.

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "sim_host/campaign/results.hpp"

namespace s4tp::campaign {

/// The paper's table, success % / time / humanness by its evaluator, one block for each kind of world and
/// guard; then a line a cell with rates, intervals and physical units. Cells without episodes are left out.
void print_table(std::ostream& out, const std::vector<CellResult>& cells);

/// For every other planner beside the first one: does it fail less, on the same episodes?
void print_paired(std::ostream& out, const std::vector<CellResult>& cells);

/// Each failure with its cause and the command that shows it, at most `limit` lines.
/// \param command  makes the command of a cell and a seed
/// \return how many failures there are
std::size_t print_failures(std::ostream& out, const std::vector<CellResult>& cells, std::size_t limit,
                           const std::function<std::string(const Cell&, std::uint64_t)>& command);

}  // namespace s4tp::campaign
