#pragma once
/// The ECU as a process of its own, on any bus.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

#include "algo/core/parameters.hpp"
#include "hal/linux/linux_can.hpp"
#include "hal/linux/realtime.hpp"
#include "hal/sim/memory_flash_bank.hpp"
#include "sim_host/processes/authentic_link.hpp"

namespace s4tp::processes {

struct EcuProcessOptions {
  std::string bus;  ///< its name, for messages
  std::string planner = "s4tp";
  bool guarded = true;  ///< baselines::make_ecu()
  Parameters parameters;
  int wait_s = 60;    ///< for the first tick
  int silence_s = 5;  ///< without a tick, after which the drive is over
  bool realtime =
      false;  ///< control and planning on threads of their own, ticks from a timer: as on a real ECU
  std::string telemetry;         ///< shared memory to write records to (sim_host/telemetry); empty: none
  std::filesystem::path report;  ///< realtime: whether it was on time, as JSON
  hal::linux_host::RealtimeKernel* kernel = nullptr;         ///< realtime: null is the one we run on
  Keys keys;                                                 ///< with authentication
  std::shared_ptr<const hal::sim::MemoryFlashBank> weights;  ///< null: those the build carries
};

enum class EcuEnd {
  kSilence,       ///< PROC-010 the bus fell silent after driving
  kStopped,       ///< PROC-011 asked to stop
  kNothingHeard,  ///< PROC-012 no tick ever came
};

/// Runs a tick for each TICK frame (realtime: PROC-015) until the bus falls silent. Mode changes, with the
/// faults behind them, and what becomes of the link are told on `out`.
///
/// PROC-013 Until the first tick it says ten times a second that it is there, with a VersionEcu frame.
/// PROC-014 Planning ends before the next tick begins, so the frames are those of the in-process drive, bit
/// by bit; with `realtime` it may take its time and miss its deadline. AUTH-034 With keys no command, motion,
/// track list or map is taken from the bus that no companion verifies, and until the first tick it says its
/// nonce, too. \throws std::invalid_argument as baselines::make_ecu()
[[nodiscard]] EcuEnd run_ecu(hal::linux_host::LinuxCan& can, const EcuProcessOptions& options,
                             std::ostream& out, const std::atomic<bool>& stop);

}  // namespace s4tp::processes
