#pragma once
/// Whether a task was on time, and whether this machine is fit for it.

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "hal/linux/latency_histogram.hpp"
#include "hal/linux/realtime.hpp"

namespace s4tp::processes {

struct RealtimeReport {
  std::string task;  ///< "ECU control", "world"
  hal::linux_host::LatencyHistogram wake_ups;
  std::vector<hal::linux_host::Grant> grants;
  hal::linux_host::KernelPreemption kernel;
  hal::linux_host::LatencyHistogram planning;  ///< what planning cycles took; the ECU's only
  unsigned deadline_misses = 0;
};

inline constexpr std::uint32_t kLate_us = 1000;
inline constexpr std::uint32_t kEnoughWakeUps = 1000;

/// RT-020 Fit is who has SCHED_FIFO and locked memory, on a kernel that is not of the weakly preempting kind,
/// and met 1000 ticks or more, 99.9 % of them less than 1 ms late and none by a whole period. \return why it
/// is not, in words; empty for fit
[[nodiscard]] std::vector<std::string> objections(const RealtimeReport& report);

/// RT-021 Numbers, histogram, what was granted, and the verdict with its reasons and remedies.
void print(std::ostream& out, const RealtimeReport& report);
/// RT-022 The same as JSON.
[[nodiscard]] nlohmann::json to_json(const RealtimeReport& report);

}  // namespace s4tp::processes
