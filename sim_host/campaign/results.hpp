#pragma once
/// Results of a campaign, cell by cell, and as JSON whose bytes depend on the episodes alone.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "sim_host/campaign/cell.hpp"
#include "sim_host/metrics/summary.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::campaign {

/// One cell with its episodes, by seed.
struct CellResult {
  Cell cell;
  metrics::Summary summary;
  std::vector<metrics::EpisodeMetrics> episodes;
};

/// In the order the rows first name the cells; episodes by seed. \throws std::runtime_error when one episode
/// is there twice with different outcomes
[[nodiscard]] std::vector<CellResult> collect(const std::vector<EpisodeRow>& rows);

/// \param header  of the campaign (episode_record.hpp): its cells come in the header's order
[[nodiscard]] std::vector<CellResult> collect(const std::vector<EpisodeRow>& rows,
                                              const nlohmann::ordered_json& header);

/// How many episodes the header's campaign has in all its parts.
[[nodiscard]] std::size_t planned_episodes(const nlohmann::ordered_json& header);

/// The document: what the campaign is, then one run a cell. Every failure is listed with its seed. Where
/// families have several roads, they come after that (families.hpp).
[[nodiscard]] nlohmann::ordered_json results_json(const nlohmann::ordered_json& header,
                                                  const std::vector<CellResult>& cells);

/// One episode and its cell as a document.
[[nodiscard]] nlohmann::ordered_json results_json(const EpisodeRow& row);

/// \throws std::runtime_error naming the file
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& document);

/// One episode in words, with its collisions.
void print_episode(std::ostream& out, const EpisodeRow& row, const traffic::Recording& recording);

}  // namespace s4tp::campaign
