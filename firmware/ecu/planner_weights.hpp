#pragma once
/// Weights out of a flash bank, for planners that take some: those that offer use_weights() and weight_status() as
/// s4tp::Planner does. Any other planner is left as it is.

#include <cstdint>
#include <type_traits>
#include <utility>

#include "algo/satp/weight_image.hpp"
#include "hal/flash_bank.hpp"

namespace s4tp::ecu {

template <class PlannerT, class = void>
inline constexpr bool kTakesWeights = false;
template <class PlannerT>
inline constexpr bool
    kTakesWeights<PlannerT, std::void_t<decltype(std::declval<PlannerT&>().use_weights(nullptr, 0U))>> = true;

/// Whether nothing was ever written where an image begins: erased flash, or memory that was only cleared.
[[nodiscard]] inline bool is_blank(const hal::FlashBank& bank) {
  std::uint32_t first = 0;
  const bool readable = bank.read(0, &first, sizeof first);
  return readable && (first == 0U || first == 0xFFFFFFFFU);
}

/// A planner and its weights.
template <class PlannerT>
struct PlannerWeights {
  /// A blank bank gives nothing: then the weights the build carries are taken.
  static void take(PlannerT& planner, const hal::FlashBank& bank) {
    if constexpr (kTakesWeights<PlannerT>) {
      if (!is_blank(bank)) static_cast<void>(planner.use_weights(bank.mapped(), bank.size()));
    }
  }

  [[nodiscard]] static satp::WeightStatus status(const PlannerT& planner) {
    if constexpr (kTakesWeights<PlannerT>) {
      return planner.weight_status();
    } else {
      return satp::WeightStatus::kAbsent;
    }
  }
};

}  // namespace s4tp::ecu
