#pragma once
/// The ECU in real time: control and planning each on a thread of its own, ticks from the ECU's own timer.
///
/// \code
///   control    SCHED_FIFO 80   frames as they come | tick, 4 ms after the motion frame | frames ..
///   planning   SCHED_FIFO 70        woken by each tick, one cycle when a boundary passed
///   the caller                 prints what control has noted
/// \endcode

#include <atomic>
#include <functional>
#include <ostream>

#include "sim_host/baselines/any_ecu.hpp"
#include "sim_host/processes/ecu_process.hpp"
#include "sim_host/processes/ecu_reporter.hpp"
#include "sim_host/processes/realtime_report.hpp"
#include "sim_host/processes/timed_bus.hpp"
#include "sim_host/telemetry/ecu_tap.hpp"

namespace s4tp::processes {

inline constexpr int kHelloEvery_ms = 100;

struct RealtimeDrive {
  EcuEnd end = EcuEnd::kStopped;
  std::uint32_t ticks = 0;
  RealtimeReport report;
};

/// PROC-015 From the first TICK frame on control runs every 10 ms of host time, whatever the bus brings,
/// phase-locked to the motion frame; planning never holds it up. Both threads ask for SCHED_FIFO, control
/// above planning, and the process for locked memory, before the first tick.
/// \param announce  called on control's thread each time it says that it is there
[[nodiscard]] RealtimeDrive drive_in_real_time(baselines::AnyEcu& ecu, TimedBus& bus,
                                               hal::linux_host::LinuxCan& can, EcuReporter& reporter,
                                               telemetry::EcuTap& tap, const EcuProcessOptions& options,
                                               const std::function<void()>& announce, std::ostream& out,
                                               const std::atomic<bool>& stop);

}  // namespace s4tp::processes
