#pragma once
/// One episode: the world and an ECU on one bus, from pre-roll to the end.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "firmware/wire/frame.hpp"
#include "sim_host/campaign/driver.hpp"
#include "sim_host/campaign/trace.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::campaign {

/// Looks on while the ECU drives; the drive is the same to the bit.
class Onlooker {
 public:
  virtual ~Onlooker() = default;
  /// Before the ECU is made. \param trace  where all that is seen goes as well, or null
  virtual void begin(Trace* trace) = 0;
  [[nodiscard]] virtual hal::Telemetry* telemetry() = 0;
  [[nodiscard]] virtual planner::Probe* probe() = 0;
  /// After each tick of the ECU.
  virtual void ticked(const Driver& driver) = 0;
};

struct EpisodeOptions {
  std::uint64_t seed = 0;
  std::string planner = "s4tp";
  bool guarded = true;  ///< make_ecu()
  scenario::PerceptionOptions perception;
  scenario::Engine engine = scenario::Engine::kBuiltin;
  Parameters parameters;
  const hal::FlashBank* weights = nullptr;   ///< ecu::Ports::weights
  std::optional<std::filesystem::path> log;  ///< candump log of every frame on the bus
  bool trace = false;                        ///< keep what the planner thought
  Onlooker* onlooker = nullptr;
  /// Also told every frame of that log, tick by tick; time is vehicle time.
  std::function<void(std::uint64_t time_us, const std::vector<wire::Frame>&)> record;
  /// Disturbs the bus: false drops the frame on its way to the ECU. Called with the time since entry [s].
  std::function<bool(double time_s, const wire::Frame& frame)> passes;
  /// Times since entry at which the running planning cycle misses its deadline [s].
  std::vector<double> deadline_misses_s;
};

struct EpisodeResult {
  traffic::Recording recording;
  map::Vec2 origin;              ///< of the odometry frame, network coordinates
  std::unique_ptr<Trace> trace;  ///< when asked for
  double cpu_s = 0.0;
  satp::WeightStatus weights = satp::WeightStatus::kAbsent;  ///< EcuCore::weights()
  std::string first_ended;                                   ///< why it was driven again; empty: it was not
};

/// SUMO-005 A drive that SUMO ends by a fault of its own is driven again from its beginning with SUMO's ego on any lane
/// near it, as most such faults come from keeping it on its route's; not so where somebody looks on or is told frames.
/// \throws traffic::EngineEnded when SUMO ends that one too, or it is not driven; std::runtime_error when the log cannot be written
[[nodiscard]] EpisodeResult run_episode(const scenario::Scenario& scenario, const EpisodeOptions& options);

}  // namespace s4tp::campaign
