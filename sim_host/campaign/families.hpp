#pragma once
/// Results by family of roads (sim_host/roads): cells that differ in their road's number only, put together.

#include <nlohmann/json.hpp>
#include <vector>

#include "sim_host/campaign/results.hpp"
#include "sim_host/metrics/paired.hpp"

namespace s4tp::campaign {

/// What a failure counts in the restricted mean time to the goal: the time limit of every road.
inline constexpr double kFailureTime_s = 80.0;

struct FamilyResult {
  Cell like;  ///< scenario: the family, or "all roads"
  int roads = 0;
  metrics::Summary summary;        ///< its intervals are those of independent episodes
  metrics::Interval interval;      ///< 95 % of the success rate, clustered by road (metrics/clusters.hpp)
  double design_effect = 1.0;      ///< of it
  double restricted_mean_s = 0.0;  ///< time to the goal, a failure counting kFailureTime_s
};

/// Whether some family has more than one road here.
[[nodiscard]] bool has_families(const std::vector<CellResult>& cells);

/// In the order of the cells; after the families of one planner, guard, flavour, traffic and perception comes
/// their sum. Cells without episodes are left out.
[[nodiscard]] std::vector<FamilyResult> by_family(const std::vector<CellResult>& cells);

/// A driver and another one on the same episodes of a family.
struct FamilyPair {
  Cell first;  ///< scenario: the family, or "all roads"
  Cell second;
  metrics::Paired paired;
  double design_effect = 1.0;  ///< of the difference
  double upper = 1.0;          ///< of the 95 % interval of first's loss of goals, clustered by road
  int first_at_fault = 0;      ///< episodes
  int second_at_fault = 0;
  double first_restricted_mean_s = 0.0;
  double second_restricted_mean_s = 0.0;
};

/// Each planner guarded beside itself bare, and the first planner beside each other one: guarded beside
/// guarded, bare beside bare, both beside one that has no guard (SUMO's driver).
[[nodiscard]] std::vector<FamilyPair> pair_families(const std::vector<CellResult>& cells);

[[nodiscard]] nlohmann::ordered_json families_json(const std::vector<FamilyResult>& families);
[[nodiscard]] nlohmann::ordered_json family_pairs_json(const std::vector<FamilyPair>& pairs);

}  // namespace s4tp::campaign
