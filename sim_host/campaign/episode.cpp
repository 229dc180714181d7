#include "sim_host/campaign/episode.hpp"

#include <ctime>

#include "firmware/wire/codec.hpp"
#include "sim_host/baselines/planner_registry.hpp"
#include "sim_host/campaign/bus_log.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::campaign {
namespace {

double cpu_now_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

EpisodeResult drive(const scenario::Scenario& scenario, const EpisodeOptions& options, bool on_any_lane) {
  const double cpu_start_s = cpu_now_s();
  EpisodeResult result;
  result.trace = std::make_unique<Trace>();
  Trace* const trace = options.trace ? result.trace.get() : nullptr;
  if (options.onlooker != nullptr) options.onlooker->begin(trace);
  hal::Telemetry* const telemetry = options.onlooker != nullptr ? options.onlooker->telemetry() : trace;
  planner::Probe* const probe = options.onlooker != nullptr ? options.onlooker->probe() : trace;
  const bool by_sumo = baselines::find_planner(options.planner).drives_in_sumo;
  const auto driver = by_sumo ? nullptr
                              : make_driver(options.planner, options.guarded, options.parameters, telemetry,
                                            probe, options.weights);
  if (driver) result.weights = driver->core().weights();
  world::WorldOptions world_options;
  world_options.seed = options.seed;
  world_options.engine = options.engine;
  world_options.perception = options.perception;
  world_options.ego_by_traffic = by_sumo;
  world_options.ego_on_any_lane = on_any_lane;
  world::World world(scenario, world_options);
  std::optional<BusLog> log;
  if (options.log)
    log.emplace(*options.log, options.seed, ecu_note(options.planner, options.guarded, options.parameters));

  std::vector<wire::Frame> from_world;
  std::vector<wire::Frame> delivered;
  std::vector<wire::Frame> from_ecu;
  std::size_t misses = 0;
  for (std::uint64_t tick = 0; !world.finished(); ++tick) {
    from_world.clear();
    delivered.clear();
    from_ecu.clear();
    world.tick(from_world);
    for (const wire::Frame& frame : from_world) {
      if (!options.passes || options.passes(world.time_s(), frame)) delivered.push_back(frame);
    }
    if (misses < options.deadline_misses_s.size() && world.time_s() >= options.deadline_misses_s[misses]) {
      ++misses;
      if (driver) driver->inject_deadline_miss();
      if (log) log->write_deadline_miss();
    }
    if (driver) driver->tick(delivered, from_ecu);
    for (const wire::Frame& frame : from_ecu) world.receive(frame);
    if (driver && options.onlooker != nullptr) options.onlooker->ticked(*driver);
    if (log) {
      log->write(tick * 10'000, delivered);
      log->write(tick * 10'000, from_ecu);
    }
    if (options.record) {
      options.record(tick * 10'000, delivered);
      options.record(tick * 10'000, from_ecu);
    }
  }
  result.origin = world.origin();
  result.recording = world.recording();
  if (!options.trace) result.trace.reset();
  result.cpu_s = cpu_now_s() - cpu_start_s;
  return result;
}

}  // namespace

EpisodeResult run_episode(const scenario::Scenario& scenario, const EpisodeOptions& options) {
  try {
    return drive(scenario, options, false);
  } catch (const traffic::EngineEnded& error) {
    const bool others_saw_it = options.record || options.onlooker != nullptr;
    if (others_saw_it || baselines::find_planner(options.planner).drives_in_sumo) throw;
    EpisodeResult again = drive(scenario, options, true);
    again.first_ended = error.what();
    return again;
  }
}

}  // namespace s4tp::campaign
