#include "algo/satp/gru_cell.hpp"

#include "algo/satp/activation.hpp"
#include "algo/satp/linear.hpp"
#include "algo/satp/requantize.hpp"

namespace s4tp::satp {
namespace {

// Product of a value and a share in 2^-15.
std::int32_t share_of(std::int32_t share_q15, std::int32_t value) {
  return (share_q15 * value + (1 << 14)) >> 15;
}

}  // namespace

GruCell gru_at(const Weights& weights) {
  return {weights.linear(kGruGates), weights.linear(kGruFromInput), weights.linear(kGruState)};
}

void gru_step(const GruCell& cell, std::int8_t (*inputs)[kGruInput], int count, GruScratch& scratch,
              std::int16_t (*states)[kHidden]) {
  auto& [gates, from_input, from_state] = scratch;
  for (int b = 0; b < count; ++b) {
    for (int c = 0; c < kHidden; ++c)
      inputs[b][kEmbed + c] = static_cast<std::int8_t>(saturate8((states[b][c] + 128) >> 8));
  }
  linear(cell.gates, {inputs[0], kGruInput}, count, Rows<std::int16_t>{gates[0], 2 * kHidden});
  linear(cell.input, {inputs[0], kGruInput}, count, Rows<std::int16_t>{from_input[0], kHidden});
  linear(cell.state, {inputs[0] + kEmbed, kGruInput}, count, Rows<std::int16_t>{from_state[0], kHidden});
  for (int b = 0; b < count; ++b) {
    sigmoid_q15(gates[b], 2 * kHidden);
    std::int16_t* candidates = from_input[b];
    const std::int16_t* keep = gates[b] + kHidden;
    for (int c = 0; c < kHidden; ++c)
      candidates[c] =
          static_cast<std::int16_t>(saturate16(candidates[c] + share_of(gates[b][c], from_state[b][c])));
    tanh_q15(candidates, kHidden);
    for (int c = 0; c < kHidden; ++c) {
      const std::int32_t candidate = candidates[c];
      states[b][c] = static_cast<std::int16_t>(candidate + share_of(keep[c], states[b][c] - candidate));
    }
  }
}

}  // namespace s4tp::satp
