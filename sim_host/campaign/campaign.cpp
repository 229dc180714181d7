#include "sim_host/campaign/campaign.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace s4tp::campaign {

std::vector<EpisodeRow> run_campaign(const std::vector<world::Scenario>& scenarios,
                                     const CampaignOptions& options) {
  struct Job {
    const std::string* planner;
    const world::Scenario* scenario;
    std::uint64_t seed;
  };
  std::vector<Job> jobs;
  for (const std::string& planner : options.planners) {
    for (const world::Scenario& scenario : scenarios) {
      for (int i = 0; i < options.episodes; ++i) {
        jobs.push_back({&planner, &scenario, options.first_seed + static_cast<std::uint64_t>(i)});
      }
    }
  }

  std::vector<EpisodeRow> rows(jobs.size());
  std::atomic<std::size_t> next{0};
  std::mutex report_mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      const Job& job = jobs[i];
      try {
        EpisodeOptions episode;
        episode.seed = job.seed;
        episode.planner = *job.planner;
        episode.engine = options.engine;
        episode.parameters = options.parameters;
        episode.trace = options.trace;
        const EpisodeResult result = run_episode(*job.scenario, episode);
        rows[i] = {job.scenario->name, *job.planner, metrics::evaluate(result.recording)};
        const std::lock_guard lock(report_mutex);
        if (options.on_episode) options.on_episode(*job.scenario, *job.planner, result);
      } catch (...) {
        const std::lock_guard lock(report_mutex);
        failure = std::current_exception();
        next = jobs.size();
      }
    }
  };
  const int wanted =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < std::max(wanted, 1); ++i) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  return rows;
}

}  // namespace s4tp::campaign
