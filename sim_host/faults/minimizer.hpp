#pragma once
/// Cuts a failing fault script down to what is needed to fail.

#include <functional>

#include "sim_host/faults/script.hpp"

namespace s4tp::faults {

/// FAULT-016 What is left fails still, and (unless `trials` ran out) no longer does when any one fault is
/// left out, halved in time from either end, struck off one message, or weakened by half. \param fails
/// whether a script fails in the way that matters \param trials  how often it may be asked \pre fails(script)
[[nodiscard]] FaultScript minimize(FaultScript script, const std::function<bool(const FaultScript&)>& fails,
                                   int trials);

}  // namespace s4tp::faults
