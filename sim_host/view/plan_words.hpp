#pragma once
/// A plan in words a passenger would understand.

#include <string>

#include "sim_host/campaign/trace.hpp"

namespace s4tp::view {

/// What the car is about to do, and what keeps it from more: "Stopping: somebody may be in the crossing with
/// us."
[[nodiscard]] std::string in_words(const campaign::CycleTrace& cycle);

}  // namespace s4tp::view
