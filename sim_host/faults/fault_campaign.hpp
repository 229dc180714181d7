#pragma once
/// Many fault scripts: runs them, counts what became of them, cuts the first failing one down.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "sim_host/faults/isolation.hpp"

namespace s4tp::faults {

struct CampaignOptions {
  int scripts = 10'000;
  std::uint64_t first_seed = 10'000;  ///< the others follow
  IsolationOptions isolation;
  int trials = 400;  ///< runs the first failing script's minimisation may take
  std::function<void(int done, int failed)> on_progress;
};

struct CampaignResult {
  std::vector<FaultScript> scripts;      ///< in the order of their seeds
  std::vector<RunResult> results;        ///< the same
  std::optional<FaultScript> minimized;  ///< of the failing one with the lowest seed

  [[nodiscard]] int failed() const;
  [[nodiscard]] std::optional<std::size_t> first_failed() const;
};

/// FAULT-017 The same seeds give the same result, whatever the number of jobs.
[[nodiscard]] CampaignResult run_campaign(const Scenarios& scenarios, const Runner& runner,
                                          const CampaignOptions& options);

/// How the scripts with each kind of fault in them ended.
void print_table(std::ostream& out, const CampaignResult& campaign);
/// \throws std::runtime_error naming the file
void write_json(const std::filesystem::path& file, const CampaignResult& campaign);

}  // namespace s4tp::faults
