#pragma once
/// How much may still be done in a stage, counted by the code itself: the same cut on every target.

#include <cstdint>

namespace s4tp {

/// More than any stage takes [WorkMeter's units].
inline constexpr std::int32_t kUnboundedWork = 1'000'000'000;

/// Units of a hundred instructions of a Cortex-M7, or less; what is charged is an upper bound of what it takes
/// (docs/budget.md).
struct WorkMeter {
  std::int32_t left = 0;
  std::int32_t reserve = 0;  ///< of it, kept for what has to be done in any case

  [[nodiscard]] bool allows(std::int32_t units) const { return left - reserve >= units; }
  void spend(std::int32_t units) { left -= units; }
};

}  // namespace s4tp
