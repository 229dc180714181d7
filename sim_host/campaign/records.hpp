#pragma once
/// The records of one or more campaigns read together, for reports: parts of a campaign join, and cells that
/// several campaigns have in common have the episodes of all of them.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/campaign/results.hpp"

namespace s4tp::campaign {

struct ReportedCell {
  CellResult result;
  std::size_t planned = 0;  ///< episodes
};

struct Records {
  std::vector<nlohmann::ordered_json> headers;  ///< one a campaign
  std::vector<ReportedCell> cells;              ///< in the headers' order
  [[nodiscard]] std::size_t done() const;
  [[nodiscard]] std::size_t planned() const;
};

/// \param paths  records (episodes.jsonl, part-*.jsonl), or folders that hold some, or the numbers (.json) of
/// a campaign beside its record; finished or not
/// \throws std::runtime_error naming what is missing, or the episode that is there twice with different
/// outcomes
[[nodiscard]] Records read_records(const std::vector<std::filesystem::path>& paths);

/// The same for a campaign that was just driven.
[[nodiscard]] Records records_of(const nlohmann::ordered_json& header, const std::vector<EpisodeRow>& rows);

/// What a header says was to be driven. \throws as load_parameters()
[[nodiscard]] CampaignPlan plan_of(const nlohmann::ordered_json& header);

/// The command that drives one of a campaign's episodes again.
[[nodiscard]] std::string replay_command(const nlohmann::ordered_json& header, const Cell& cell,
                                         std::uint64_t seed);

}  // namespace s4tp::campaign
