#include "sim_host/view/failure_replays.hpp"

#include <algorithm>
#include <vector>

#include "sim_host/campaign/episode_record.hpp"
#include "sim_host/campaign/progress.hpp"
#include "sim_host/view/replay.hpp"

namespace s4tp::view {
namespace {

using campaign::Cell;
using metrics::EpisodeMetrics;

/// The failures of a cell that are shown.
std::vector<const EpisodeMetrics*> chosen(const campaign::CellResult& cell, std::size_t most) {
  std::vector<const EpisodeMetrics*> failures;
  for (const EpisodeMetrics& episode : cell.episodes) {
    if (episode.ending != traffic::Ending::kGoal) failures.push_back(&episode);
  }
  std::stable_sort(failures.begin(), failures.end(), [](const auto* a, const auto* b) {
    return (a->collisions_at_fault > 0) > (b->collisions_at_fault > 0);
  });
  failures.resize(std::min(failures.size(), most));
  return failures;
}

}  // namespace

Replays write_failure_replays(const campaign::Records& records, const ReplayOptions& options,
                              const std::filesystem::path& folder) {
  std::map<std::pair<Cell, std::uint64_t>, EpisodeMetrics> wanted;
  for (const campaign::ReportedCell& cell : records.cells) {
    for (const EpisodeMetrics* const episode : chosen(cell.result, options.per_cell)) {
      wanted[{cell.result.cell, episode->seed}] = *episode;
    }
  }
  if (!wanted.empty()) std::filesystem::create_directories(folder);

  campaign::ConsoleProgress progress(wanted.size());
  Replays written;
  for (const auto& header : records.headers) {
    campaign::Campaign campaign = campaign::load_campaign(campaign::plan_of(header), options.scenario_root);
    std::vector<campaign::Job> jobs = campaign::jobs_of(campaign);
    std::erase_if(jobs, [&](const campaign::Job& job) {
      const std::pair key{campaign.cells[job.cell].cell, job.seed};
      return !wanted.contains(key) || written.contains(key);
    });
    campaign::CampaignOptions run;
    run.threads = options.threads;
    run.trace = true;
    run.stop = options.stop;
    run.on_episode = [&](const campaign::CampaignCell& cell, const campaign::EpisodeRow& row,
                         const campaign::EpisodeResult& result) {
      const std::pair key{row.cell, row.metrics.seed};
      const campaign::EpisodeRow recorded{row.cell, wanted.at(key)};
      const std::string name = replay_name(row.cell, row.metrics.seed);
      write_replay({cell.scenario->scenario, result, row,
                    campaign::replay_command(header, row.cell, row.metrics.seed), recorded},
                   folder / name);
      written[key] = {name, changed(recorded, row)};
      progress.done("replay of " + words(row.cell) + ", seed " + std::to_string(row.metrics.seed));
    };
    (void)campaign::run_campaign(campaign, jobs, run);
  }
  progress.end();
  return written;
}

}  // namespace s4tp::view
