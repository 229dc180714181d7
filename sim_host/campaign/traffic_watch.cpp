#include "sim_host/campaign/traffic_watch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sim_host/world/engine_factory.hpp"

namespace s4tp::campaign {
namespace {

constexpr int kTicksPerSnapshot = 10;
constexpr double kOnlyOnce_per_min = 0.1;  // the second one would come 10 minutes later

scenario::FlowGroup neutral_driver(const scenario::Scenario& scenario) {
  const auto& lanes = scenario.network.lanes;
  scenario::FlowGroup group;
  group.routes = {{scenario.mission.edges, lanes[static_cast<std::size_t>(scenario.mission.start_lane)].index,
                   lanes[static_cast<std::size_t>(scenario.mission.goal_lane)].index}};
  group.vehicles_per_minute = {kOnlyOnce_per_min, kOnlyOnce_per_min};
  group.begin_s = {scenario.mission.entry_time_s, scenario.mission.entry_time_s};
  return group;
}

metrics::TrafficSamples watch_one(const scenario::Scenario& scenario, const WatchOptions& options,
                                  std::uint64_t seed) {
  const std::unique_ptr<traffic::TrafficEngine> engine = world::make_engine(scenario, {options.engine, seed});
  std::vector<traffic::Snapshot> snapshots;
  const auto count = static_cast<int>(std::lround(options.duration_s / traffic::kSnapshotPeriod_s));
  for (int i = 1; i <= count; ++i) {
    for (int tick = 0; tick < kTicksPerSnapshot; ++tick) {
      engine->step(nullptr);
    }
    traffic::Snapshot snapshot;
    snapshot.time_s = i * traffic::kSnapshotPeriod_s;
    snapshot.others = engine->cars();
    snapshots.push_back(std::move(snapshot));
  }
  return metrics::observe_traffic(scenario.network, snapshots);
}

}  // namespace

metrics::TrafficRun watch_traffic(const scenario::Scenario& scenario, const WatchOptions& options) {
  scenario::Scenario watched = scenario;
  if (options.neutral_driver && watched.route_files.empty()) {
    watched.flows.push_back(neutral_driver(scenario));
  }
  std::vector<metrics::TrafficSamples> samples(static_cast<std::size_t>(options.episodes));
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  int done = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < samples.size(); i = next++) {
      try {
        samples[i] = watch_one(watched, options, options.first_seed + i);
        const std::lock_guard lock(mutex);
        ++done;
        if (options.on_episode) options.on_episode(done);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        next = samples.size();
      }
    }
  };
  {
    const int wanted =
        options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (int i = 0; i < std::max(wanted, 1); ++i) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  metrics::TrafficRun run;
  run.scenario = scenario.name;
  run.flavour = scenario.flavour.empty() ? "smarts" : scenario.flavour;
  run.engine = scenario::engine_names().at(static_cast<std::size_t>(options.engine));
  run.episodes = options.episodes;
  for (const metrics::TrafficSamples& some : samples) run.samples.add(some);  // in order of seeds
  return run;
}

}  // namespace s4tp::campaign
