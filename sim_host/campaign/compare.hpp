#pragma once
/// Planners compared on the same episodes.

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "sim_host/campaign/results.hpp"
#include "sim_host/metrics/paired.hpp"

namespace s4tp::campaign {

/// Which episodes of a cell failed.
struct Outcomes {
  Cell cell;
  std::map<std::uint64_t, bool> failed;  ///< by seed
};

[[nodiscard]] Outcomes outcomes_of(const CellResult& cell);
/// From a document of results_json(). \throws std::runtime_error when a run is not complete: its seeds are
/// not known then; std::exception when it is no such document
[[nodiscard]] std::vector<Outcomes> outcomes_of(const nlohmann::ordered_json& document);

struct ComparedCell {
  Cell cell;  ///< of the first planner
  metrics::Paired paired;
};

/// Cells of the first planner with those of the second that are alike in all else, on the seeds both have;
/// after those that differ in scenario only comes their sum, the scenario of which is "all scenarios". Empty
/// names: every planner with itself.
[[nodiscard]] std::vector<ComparedCell> pair_up(const std::vector<Outcomes>& first,
                                                const std::string& first_planner,
                                                const std::vector<Outcomes>& second,
                                                const std::string& second_planner);

/// As McNemar's test has it: the first is better, worse, no worse, or it is open.
[[nodiscard]] const char* verdict(const metrics::Paired& paired);

/// A list of cells with counts, McNemar's p and the verdict.
[[nodiscard]] nlohmann::ordered_json comparison_json(const std::vector<ComparedCell>& cells);

void print_comparison(std::ostream& out, const std::vector<ComparedCell>& cells, const std::string& first,
                      const std::string& second);

}  // namespace s4tp::campaign
