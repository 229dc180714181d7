#pragma once
/// Runs fault scripts, each in a process of its own: what crashes or hangs there ends nothing but itself, and
/// the script that did it is known.

#include <cstddef>
#include <functional>
#include <vector>

#include "sim_host/faults/fault_run.hpp"

namespace s4tp::faults {

using Runner = std::function<RunResult(const FaultScript&)>;

struct IsolationOptions {
  int jobs = 1;           ///< processes at a time
  double limit_s = 60.0;  ///< host time a script may take before it counts as hanging
};

/// FAULT-015 A script whose process ends by a signal or an exception is a kCrash with what it said last, one
/// that takes too long a kHang; the others run on.
/// \param on_done  told of each script once, as they end; false: start no more
/// \throws std::runtime_error when no process can be started
void run_isolated(const std::vector<FaultScript>& scripts, const Runner& runner,
                  const IsolationOptions& options,
                  const std::function<bool(std::size_t index, const RunResult& result)>& on_done);

}  // namespace s4tp::faults
