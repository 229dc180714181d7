#pragma once
/// Results of a campaign as a terminal table and as JSON.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "sim_host/campaign/campaign.hpp"
#include "sim_host/metrics/summary.hpp"

namespace s4tp::campaign {

/// One cell of the table: a planner in a scenario.
struct ResultCell {
  std::string planner;
  std::string scenario;
  metrics::Summary summary;
};

/// In the order the rows first name them.
[[nodiscard]] std::vector<ResultCell> summarize(const std::vector<EpisodeRow>& rows);

void print_table(std::ostream& out, const std::vector<ResultCell>& cells);

/// One episode in words, with its collisions.
void print_episode(std::ostream& out, const EpisodeRow& row, const world::Recording& recording);

/// Cells and every episode. \param more  an object whose members are written, too; may be null
/// \throws std::runtime_error naming the file
void write_json(const std::filesystem::path& file, const std::vector<EpisodeRow>& rows,
                const CampaignOptions& options, const nlohmann::json* more = nullptr);

}  // namespace s4tp::campaign
