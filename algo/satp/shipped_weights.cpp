#include "algo/satp/shipped_weights.hpp"

namespace s4tp::satp {

#if defined(S4TP_LEARNED_PREDICTOR)

namespace {
[[gnu::section(".weights")]] alignas(8) constexpr std::uint32_t kImage[] = {
#include "algo/satp/shipped_weights.inc"
};
}  // namespace

ShippedWeights shipped_weights() {
  return {kImage, sizeof kImage};
}

#else

ShippedWeights shipped_weights() {
  return {};
}

#endif

}  // namespace s4tp::satp
