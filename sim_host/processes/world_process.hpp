#pragma once
/// The world as a process of its own, on any bus.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "hal/linux/linux_can.hpp"
#include "sim_host/processes/authentic_link.hpp"
#include "sim_host/processes/realtime_report.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_engine.hpp"

namespace s4tp::processes {

struct WorldProcessOptions {
  std::string bus;  ///< its name, for messages
  std::uint64_t seed = 0;
  scenario::Engine engine = scenario::Engine::kBuiltin;
  scenario::PerceptionOptions perception;
  bool realtime = false;
  bool paced = false;  ///< lock-step: a tick takes 10 ms of host time at least, for onlookers
  int wait_s = 10;     ///< for a sign of the ECU; 0: begin at once
  std::optional<std::filesystem::path> log;  ///< every frame of the bus from the first tick on
  /// Also told every frame of that log; time is vehicle time.
  std::function<void(std::uint64_t time_us, const std::vector<wire::Frame>&)> record;
  std::string ecu_note;              ///< for the log's first line, campaign::ecu_note()
  int answer_within_ms = 1000;       ///< lock-step: after that the next tick begins all the same
  int dead_after_ms = 2000;          ///< lock-step: without any answer
  int link_back_within_ms = 30'000;  ///< lock-step: so long a link that is down is waited for
  std::function<bool()> ecu_lives;   ///< may be empty; false ends the wait for it
  hal::linux_host::RealtimeKernel* kernel = nullptr;  ///< realtime: null is the one we run on
  Keys keys;  ///< with authentication; the log has no companion frames then
  /// Lock-step with an ECU that is given little time: so long for each answer, twice that before it is dead.
  void wait_for_answers(int seconds) {
    answer_within_ms = 1000 * seconds;
    dead_after_ms = 2000 * seconds;
  }
};

struct WorldProcessResult {
  bool met_ecu = false;  ///< false: nothing was driven
  traffic::Recording recording;
  int ticks = 0;
  int unanswered = 0;                    ///< ticks without an answer
  int refused_commands = 0;              ///< Command frames that answered no tick
  std::optional<RealtimeReport> timing;  ///< realtime
};

/// PROC-020 Begins when a VersionEcu frame shows that an ECU is there, says so when none comes.
/// PROC-021 Lock-step: the next tick begins when a Command frame whose CRC fits echoes the number of this one
/// (paced: PROC-025 and not before 10 ms have passed). Without one for answer_within_ms of host time it begins
/// all the same; PROC-022 after dead_after_ms without any, or when ecu_lives says no, the ECU is dead, and the
/// episode ends as the world sees fit. While the link is down or off nothing is counted for link_back_within_ms, if it comes back. PROC-023
/// Realtime: a tick every 10 ms of host time, whatever the ECU does; a world that is a period late or later
/// skips ticks, so the car's time stands still for them. The calling thread asks for SCHED_FIFO and keeps it.
/// PROC-024 A Command frame reaches the car only if its CRC fits and its echo is the present tick's (realtime:
/// one of the last 10), so a frame recorded earlier never does. The car's own protection comes after that.
/// AUTH-033 With keys it begins when an ECU has said its nonce, too, and a Command frame is one only if its
/// companion verifies.
/// \throws std::runtime_error when the log cannot be written
[[nodiscard]] WorldProcessResult run_world(const scenario::Scenario& scenario, hal::linux_host::LinuxCan& can,
                                           const WorldProcessOptions& options, std::ostream& out,
                                           const std::atomic<bool>& stop);

/// What the bus had to do with it: ticks, answers; realtime: whether they were on time.
void print_link(std::ostream& out, const WorldProcessOptions& options, const WorldProcessResult& result,
                hal::linux_host::LinuxCan& can);

}  // namespace s4tp::processes
