#pragma once
/// The network's inner loop on Cortex-M with the DSP extension: two products an instruction, on halves of
/// words. Internal: for linear.cpp.
///
/// Four weights w0 .. w3 in a word become (w0, w2) and (w1, w3); inputs are kept in the same pairs, those of
/// a batch side by side. Inputs of int8 are kept 256 times as large, as are their sums, so that rescaling
/// is one instruction behind both kinds.

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "algo/satp/kernel_dsp_products.hpp"
#include "algo/satp/kernels.hpp"
#include "algo/satp/output.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp::dsp {

inline constexpr int kMaxPairs = kMaxColumns / 2;

template <typename In>
inline constexpr int kShift = sizeof(In) == 1 ? 8 : 0;

inline std::uint32_t load(const void* from) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}

inline void pair_up(const std::int8_t* input, std::uint32_t& even, std::uint32_t& odd) {
  constexpr std::uint32_t kUpperBytes = 0xFF00FF00U;
  const std::uint32_t word = load(input);
  even = (word << 8U) & kUpperBytes;
  odd = word & kUpperBytes;
}
inline void pair_up(const std::int16_t* input, std::uint32_t& even, std::uint32_t& odd) {
  const std::uint32_t first = load(input);
  const std::uint32_t second = load(input + 2);
  even = (first & 0xFFFFU) | (second << 16U);
  odd = (first >> 16U) | (second & 0xFFFF0000U);
}

template <typename Output, typename In>
typename Output::Type output_of(std::int32_t sum, std::int32_t multiplier) {
  if constexpr (Output::kRescaled) {
    return Output::of(requantize_wide(sum, multiplier));
  } else {
    return Output::of(sum >> kShift<In>, multiplier);
  }
}

/// Inputs of a batch in pairs, side by side. \return the end of them
template <int kBatch, typename In>
[[gnu::always_inline]] inline const std::uint32_t* pair_up_rows(Rows<const In> inputs, int columns,
                                                                std::uint32_t* pairs) {
  std::uint32_t* end = pairs;
#pragma GCC unroll 1
  for (int j = 0; j < columns; j += 4, end += 2 * kBatch) {
#pragma GCC unroll 3
    for (int i = 0; i < kBatch; ++i) pair_up(inputs[i] + j, end[i], end[kBatch + i]);
  }
  return end;
}

/// Outputs of two rows.
template <typename Output, int kBatch, typename In>
[[gnu::always_inline]] inline void store_pair(const std::int32_t (&a)[kBatch],
                                              const std::int32_t (&b)[kBatch], const std::int32_t* multiplier,
                                              Rows<typename Output::Type> outputs) {
  const std::int32_t first = multiplier[0];
  const std::int32_t second = multiplier[1];
  typename Output::Type* to = outputs.data;
#pragma GCC unroll 3
  for (int i = 0; i < kBatch; ++i, to += outputs.stride) {
    to[0] = output_of<Output, In>(a[i], first);
    to[1] = output_of<Output, In>(b[i], second);
  }
}

/// Of kBatch inputs and at least two rows.
template <typename Output, int kBatch, typename In>
void multiply_batch(const Linear& layer, int distance, const std::int32_t* bias, int bias_stride,
                    Rows<const In> inputs, Rows<typename Output::Type> outputs) {
  std::uint32_t pairs[kMaxPairs * kBatch];
  const std::uint32_t* const end = pair_up_rows<kBatch>(inputs, layer.stride, pairs);
  const bool by_sixteen = layer.stride % 16 == 0;
  const int last = layer.rows - 2;  // of an odd number of rows the last pair overlaps the one before it
  const std::int8_t* weights = layer.weights;
  const std::int32_t* multiplier = layer.multiplier;
  int o = 0;
  while (true) {
    std::int32_t a[kBatch];
    std::int32_t b[kBatch];
    const std::int32_t* from = bias + o;
#pragma GCC unroll 3
    for (int i = 0; i < kBatch; ++i, from += bias_stride) {
      a[i] = from[0] * (1 << kShift<In>);
      b[i] = from[1] * (1 << kShift<In>);
    }
    add_products<kBatch, 0>(weights + o * layer.stride, distance, pairs, end, by_sixteen, a, b);
    store_pair<Output, kBatch, In>(a, b, multiplier + o, {outputs.data + o, outputs.stride});
    if (o == last) return;
    o = o + 2 < last ? o + 2 : last;
  }
}

/// Three inputs, rows of a known stride, an even number of them: where most of the network's time
/// goes. \tparam kOwnBias  each input has a bias of its own
template <typename Output, typename In, int kStride, bool kOwnBias = false>
void multiply_known(const Linear& layer, const std::int32_t* bias, Rows<const In> inputs,
                    Rows<typename Output::Type> outputs) {
  std::uint32_t pairs[kStride / 2 * 3];
  const std::uint32_t* const end = pair_up_rows<3>(inputs, kStride, pairs);
  const std::int8_t* weights = layer.weights;
  const std::int32_t* const last = bias + layer.rows;
  const std::int32_t* multiplier = layer.multiplier;
  typename Output::Type* to = outputs.data;
  do {
    const std::int32_t first_bias = bias[0] * (1 << kShift<In>);
    const std::int32_t second_bias = bias[1] * (1 << kShift<In>);
    std::int32_t a[3] = {first_bias, first_bias, first_bias};
    std::int32_t b[3] = {second_bias, second_bias, second_bias};
    if constexpr (kOwnBias) {
#pragma GCC unroll 2
      for (int i = 1; i < 3; ++i) {
        a[i] = bias[i * layer.rows] * (1 << kShift<In>);
        b[i] = bias[i * layer.rows + 1] * (1 << kShift<In>);
      }
    }
    add_products<3, kStride>(weights, 0, pairs, end, true, a, b);
    store_pair<Output, 3, In>(a, b, multiplier, {to, outputs.stride});
    weights += 2 * kStride;
    bias += 2;
    multiplier += 2;
    to += 2;
  } while (bias != last);
}

/// \return whether it was one of those
template <typename Output, typename In>
bool multiply_if_known(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                       Rows<typename Output::Type> outputs) {
  constexpr bool kBytes = sizeof(typename Output::Type) == 1;
  if constexpr (Output::kRescaled) {
    if (layer.rows % 2 != 0) return false;
    const auto known = [&](auto stride) {
      multiply_known<Output, In, stride.value>(layer, bias, inputs, outputs);
      return true;
    };
    if constexpr (sizeof(In) == 2) {
      if (bias_stride != 0) return false;
      if (layer.stride == 8) return known(std::integral_constant<int, 8>());
      if (!kBytes && layer.stride == 12) return known(std::integral_constant<int, 12>());
    } else if constexpr (kBytes) {
      if (layer.stride != 32) return false;
      if (bias_stride == 0) return known(std::integral_constant<int, 32>());
      if (bias_stride != layer.rows) return false;
      multiply_known<Output, In, 32, true>(layer, bias, inputs, outputs);
      return true;
    } else {
      if (bias_stride != 0) return false;
      if (layer.stride == 32) return known(std::integral_constant<int, 32>());
      if (layer.stride == 48) return known(std::integral_constant<int, 48>());
      if (layer.stride == 80) return known(std::integral_constant<int, 80>());
      if (layer.stride == 128) return known(std::integral_constant<int, 128>());
    }
  }
  return false;
}

// A single row is computed twice.
template <typename Output, int kBatch, typename In>
void multiply_row(const Linear& layer, const std::int32_t* bias, Rows<const In> inputs,
                  Rows<typename Output::Type> outputs) {
  const std::int32_t biases[2] = {*bias, *bias};
  const std::int32_t multipliers[2] = {*layer.multiplier, *layer.multiplier};
  typename Output::Type twice[kBatch][2];
  Linear pair = layer;
  pair.multiplier = multipliers;
  pair.rows = 2;
  multiply_batch<Output, kBatch, In>(pair, 0, biases, 0, inputs, {twice[0], 2});
  for (int i = 0; i < kBatch; ++i) outputs[i][0] = twice[i][0];
}

}  // namespace s4tp::satp::dsp

namespace s4tp::satp {

template <typename Output, typename In>
void multiply_rows(const Linear& layer, const std::int32_t* bias, int bias_stride, Rows<const In> inputs,
                   int count, Rows<typename Output::Type> outputs) {
  constexpr int kTogether = sizeof(In) == 1 ? 2 : 3;  // where the stride is not known
  int i = 0;
  while (i < count) {
    const std::int32_t* from = bias + i * bias_stride;
    const Rows<const In> these{inputs[i], inputs.stride};
    const Rows<typename Output::Type> those{outputs[i], outputs.stride};
    const bool several = count - i >= kTogether;
    if (layer.rows == 1 && several && bias_stride == 0) {
      dsp::multiply_row<Output, kTogether, In>(layer, from, these, those);
      i += kTogether;
    } else if (layer.rows == 1) {
      dsp::multiply_row<Output, 2, In>(layer, from, {these.data, 0}, {those.data, 0});
      i += 1;
    } else if (count - i >= 3 && dsp::multiply_if_known<Output, In>(layer, from, bias_stride, these, those)) {
      i += 3;
    } else if (several) {
      dsp::multiply_batch<Output, kTogether, In>(layer, layer.stride, from, bias_stride, these, those);
      i += kTogether;
    } else {
      const int pair = i + 1 < count ? 1 : 0;  // a single input is computed twice
      dsp::multiply_batch<Output, 2, In>(layer, layer.stride, from, pair * bias_stride,
                                         {these.data, pair * these.stride},
                                         {those.data, pair * those.stride});
      i += 2;
    }
  }
}

}  // namespace s4tp::satp
