#pragma once
/// The weights this build carries, linked as a constant in a section of their own (.weights).
///
/// The training's export writes algo/satp/shipped_weights.inc, the image's words; a build configured with
/// S4TP_LEARNED_PREDICTOR carries them, any other none.

#include <cstdint>

namespace s4tp::satp {

struct ShippedWeights {
  const void* image = nullptr;  ///< null: none
  std::uint32_t size_bytes = 0;
};

[[nodiscard]] ShippedWeights shipped_weights();

}  // namespace s4tp::satp
