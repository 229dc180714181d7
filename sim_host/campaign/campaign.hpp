#pragma once
/// Many episodes: planners x scenarios x flavours x traffic x guard, the same seeds in every cell.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "sim_host/campaign/cell.hpp"
#include "sim_host/campaign/episode.hpp"
#include "sim_host/world/scenario/scenario.hpp"

namespace s4tp::campaign {

/// Everything the numbers of a campaign depend on, beside the build.
struct CampaignPlan {
  std::vector<std::string> planners{"s4tp"};
  std::vector<std::string> scenarios{"left_turn", "merge", "cruise", "overtake"};  ///< names, folders, .toml
  std::vector<std::string> flavours{"smarts"};
  std::vector<std::string> traffic{"builtin"};
  std::vector<bool> guards{true};
  std::string perception = "ideal";
  int episodes = 20;  ///< per cell
  std::uint64_t first_seed = 0;
  Parameters parameters;
};

struct CampaignScenario {
  std::string argument;  ///< as it was named in the plan
  std::string digest;    ///< of its files' bytes
  scenario::Scenario scenario;
};

struct CampaignCell {
  Cell cell;
  std::shared_ptr<const CampaignScenario> scenario;
};

struct Campaign {
  CampaignPlan plan;
  std::vector<CampaignCell> cells;  ///< in the order planner, guard, traffic, flavour, scenario
  [[nodiscard]] std::size_t episodes() const {
    return cells.size() * static_cast<std::size_t>(plan.episodes);
  }
};

/// Loads what the plan names. \param scenario_root  where the shipped ones lie
/// \throws std::runtime_error, std::invalid_argument: what cannot be loaded, or two scenarios of one name
[[nodiscard]] Campaign load_campaign(const CampaignPlan& plan, const std::filesystem::path& scenario_root);

/// One episode to be driven.
struct Job {
  std::size_t cell = 0;  ///< index into Campaign::cells
  std::uint64_t seed = 0;
};

/// The `index`th of `count` parts of a campaign; parts are equally long, and every cell has a share of each.
struct Shard {
  int index = 1;  ///< 1 .. count
  int count = 1;
};

/// In the order cell, seed.
[[nodiscard]] std::vector<Job> jobs_of(const Campaign& campaign, const Shard& shard = {});

struct CampaignOptions {
  int threads = 0;                          ///< 0: one per core
  bool trace = false;                       ///< results carry what the planner thought, for pictures
  const std::atomic<bool>* stop = nullptr;  ///< once true, no further episode begins
  /// Called after each episode, one call at a time.
  std::function<void(const CampaignCell&, const EpisodeRow&, const EpisodeResult&)> on_episode;
  /// Called for each episode that could not be driven, as when SUMO ends in the middle of it; the others are driven
  /// all the same, unless these become many. Empty: the first one ends the campaign.
  std::function<void(const std::string& why)> on_failure;
};

/// Drives the jobs. The rows are those that were driven, in the jobs' order, whatever the threads did.
/// \throws std::runtime_error naming the episode that threw, and why
[[nodiscard]] std::vector<EpisodeRow> run_campaign(const Campaign& campaign, const std::vector<Job>& jobs,
                                                   const CampaignOptions& options);

}  // namespace s4tp::campaign
