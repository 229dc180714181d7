#pragma once
/// Gated recurrent unit; the state is int16, so that it does not drift over the steps.
/// Internal: for algo/satp's own sources.

#include <cstdint>

#include "algo/satp/kernels.hpp"
#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

inline constexpr int kHidden = kMcuShape.hidden;
inline constexpr int kEmbed = kMcuShape.embed;
inline constexpr int kGruInput = kEmbed + kHidden;

struct GruCell {
  Linear gates, input, state;
};
[[nodiscard]] GruCell gru_at(const Weights& weights);

/// Room for one call of gru_step.
struct GruScratch {
  std::int16_t gates[kMaxBatch][2 * kHidden];
  std::int16_t from_input[kMaxBatch][kHidden];
  std::int16_t from_state[kMaxBatch][kHidden];
};

/// states = (1 - z) n + z states, with n = tanh(input x + r (state h)), (r, z) = sigmoid(gates [x, h]).
/// SATP-026 States stay in -32767 .. 32767. \param inputs  [x, room for h]; h is filled in here
/// \param states  2^-15 \pre 1 <= count <= kMaxBatch
void gru_step(const GruCell& cell, std::int8_t (*inputs)[kGruInput], int count, GruScratch& scratch,
              std::int16_t (*states)[kHidden]);

}  // namespace s4tp::satp
