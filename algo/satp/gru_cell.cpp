#include "algo/satp/gru_cell.hpp"

#include "algo/satp/activation.hpp"
#include "algo/satp/lanes.hpp"
#include "algo/satp/linear.hpp"

namespace s4tp::satp {

GruCell gru_at(const Weights& weights) {
  return {weights.linear(kGruGates), weights.linear(kGruFromInput), weights.linear(kGruState)};
}

void gru_step(const GruCell& cell, std::int8_t (*inputs)[kGruInput], int count, GruScratch& scratch,
              std::int16_t (*states)[kHidden]) {
  auto& [gates, from_input, from_state] = scratch;
  for (int b = 0; b < count; ++b) lanes::narrow(states[b], kHidden, inputs[b] + kEmbed);
  linear(cell.gates, {inputs[0], kGruInput}, count, Rows<std::int16_t>{gates[0], 2 * kHidden});
  linear(cell.input, {inputs[0], kGruInput}, count, Rows<std::int16_t>{from_input[0], kHidden});
  linear(cell.state, {inputs[0] + kEmbed, kGruInput}, count, Rows<std::int16_t>{from_state[0], kHidden});
  for (int b = 0; b < count; ++b) {
    sigmoid_q15(gates[b], 2 * kHidden);
    std::int16_t* candidates = from_input[b];
    lanes::add_shares(gates[b], from_state[b], kHidden, candidates);
    tanh_q15(candidates, kHidden);
    lanes::blend(gates[b] + kHidden, candidates, kHidden, states[b]);
  }
}

}  // namespace s4tp::satp
