#pragma once
/// Many episodes: planners x scenarios x seeds, the same seeds for every planner.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/metrics/metrics.hpp"
#include "sim_host/world/scenario.hpp"

namespace s4tp::campaign {

struct CampaignOptions {
  std::vector<std::string> planners{"s4tp"};
  world::Engine engine = world::Engine::kBuiltin;
  int episodes = 20;             ///< per planner and scenario
  std::uint64_t first_seed = 0;  ///< the others follow
  Parameters parameters;
  int threads = 0;  ///< 0: one per core
  /// Called after each episode, one call at a time.
  std::function<void(const world::Scenario&, const std::string& planner, const EpisodeResult&)> on_episode;
  bool trace = false;  ///< results carry what the planner thought, for pictures
};

/// One episode's outcome.
struct EpisodeRow {
  std::string scenario;
  std::string planner;
  metrics::EpisodeMetrics metrics;
};

/// Runs everything; rows in the order planner, scenario, seed, whatever the threads did.
/// \throws what an episode throws
[[nodiscard]] std::vector<EpisodeRow> run_campaign(const std::vector<world::Scenario>& scenarios,
                                                   const CampaignOptions& options);

}  // namespace s4tp::campaign
