#pragma once
/// Traffic without a planner, watched for its statistics.

#include <cstdint>
#include <functional>

#include "sim_host/metrics/traffic_figures.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::campaign {

struct WatchOptions {
  scenario::Engine engine = scenario::Engine::kBuiltin;
  int episodes = 20;
  std::uint64_t first_seed = 0;  ///< the others follow
  double duration_s = 120.0;     ///< of each, from an empty road
  /// One more driver on the mission's way, from the time of entry on; traffic like all others.
  bool neutral_driver = false;
  int threads = 0;                      ///< 0: one per core
  std::function<void(int)> on_episode;  ///< how many are done; one call at a time
};

/// \throws what an engine throws
[[nodiscard]] metrics::TrafficRun watch_traffic(const scenario::Scenario& scenario,
                                                const WatchOptions& options);

}  // namespace s4tp::campaign
