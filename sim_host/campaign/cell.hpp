#pragma once
/// What the episodes of a campaign have in common and what tells them apart.

#include <compare>
#include <cstdint>
#include <string>

#include "sim_host/metrics/metrics.hpp"

namespace s4tp::campaign {

/// A cell of the table: who drives where. Every cell has the same seeds.
struct Cell {
  std::string planner = "s4tp";
  std::string scenario;  ///< its name
  std::string flavour = "smarts";
  std::string traffic = "builtin";
  bool guarded = true;
  std::string perception = "ideal";
  auto operator<=>(const Cell&) const = default;
};

/// One episode's outcome.
struct EpisodeRow {
  Cell cell;
  metrics::EpisodeMetrics metrics;
};

/// The cell in words: "s4tp, bare, left_turn, social, builtin traffic"; what is default is left out.
[[nodiscard]] std::string words(const Cell& cell);

/// The command that drives one episode again, with its picture and reasons.
/// \param scenario_argument  how the scenario was named on the command line
/// \param parameters_file    may be empty: defaults
[[nodiscard]] std::string replay_command(const Cell& cell, const std::string& scenario_argument,
                                         const std::string& parameters_file, std::uint64_t seed);

}  // namespace s4tp::campaign
