#pragma once
/// Results as tables for a page.

#include <string>

#include "sim_host/campaign/records.hpp"
#include "sim_host/view/charts.hpp"

namespace s4tp::view {

/// The paper's table: planner by scenario, as the competition counts. \param cells  alike in all else
[[nodiscard]] std::string competition_table(const Cells& cells);

/// A line a cell: rates with their intervals, times, gaps, comfort.
[[nodiscard]] std::string outcome_table(const std::vector<const campaign::ReportedCell*>& cells);

/// s4tp beside each other planner on the same episodes; empty without pairs.
[[nodiscard]] std::string paired_table(const Cells& cells);

/// Families of roads (campaign/families.hpp): a line for each family and driver, then pairs of drivers on the
/// same episodes; empty where no family has several roads.
[[nodiscard]] std::string family_tables(const Cells& cells);

/// "guarded" or "bare"
[[nodiscard]] std::string guard_words(const campaign::Cell& cell);

}  // namespace s4tp::view
