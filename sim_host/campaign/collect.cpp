// Episodes sorted into their cells.

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/results.hpp"

namespace s4tp::campaign {
namespace {

using nlohmann::ordered_json;

std::vector<Cell> cells_of(const ordered_json& header) {
  std::vector<Cell> cells;
  for (const ordered_json& cell : header.at("cells")) cells.push_back(cell_of(cell));
  return cells;
}

CellResult result_of(const Cell& cell, std::vector<metrics::EpisodeMetrics> episodes) {
  std::sort(episodes.begin(), episodes.end(), [](const auto& a, const auto& b) { return a.seed < b.seed; });
  metrics::Summary summary = metrics::summarize(episodes);
  return {cell, std::move(summary), std::move(episodes)};
}

/// By cell, each episode once.
std::map<Cell, std::vector<metrics::EpisodeMetrics>> sorted_out(const std::vector<EpisodeRow>& rows) {
  std::map<Cell, std::vector<metrics::EpisodeMetrics>> episodes;
  std::map<std::pair<Cell, std::uint64_t>, std::string> seen;
  for (const EpisodeRow& row : rows) {
    const std::string line = to_json(row).dump();
    const auto [known, fresh] = seen.emplace(std::pair{row.cell, row.metrics.seed}, line);
    if (fresh) {
      episodes[row.cell].push_back(row.metrics);
    } else if (known->second != line) {
      throw std::runtime_error(words(row.cell) + ", seed " + std::to_string(row.metrics.seed) +
                               " is there twice, with different outcomes");
    }
  }
  return episodes;
}

}  // namespace

std::vector<CellResult> collect(const std::vector<EpisodeRow>& rows) {
  auto episodes = sorted_out(rows);
  std::vector<CellResult> results;
  for (const EpisodeRow& row : rows) {
    const auto found = episodes.find(row.cell);
    if (found == episodes.end()) continue;
    results.push_back(result_of(row.cell, std::move(found->second)));
    episodes.erase(found);
  }
  return results;
}

std::vector<CellResult> collect(const std::vector<EpisodeRow>& rows, const ordered_json& header) {
  auto episodes = sorted_out(rows);
  std::vector<CellResult> results;
  for (const Cell& cell : cells_of(header)) results.push_back(result_of(cell, std::move(episodes[cell])));
  return results;
}

std::size_t planned_episodes(const ordered_json& header) {
  return cells_of(header).size() * header.at("episodes").get<std::size_t>();
}

}  // namespace s4tp::campaign
