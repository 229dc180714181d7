#pragma once
/// The two inner loops of the network, for whatever processor this is: int8 weights times int8 or int16
/// activations, summed in 32 bits.
///
/// SATP-020 Every kernel gives the bits of reference::multiply, on every target.
/// Internal: for algo/satp's own sources.

#include <cstdint>

#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

/// Most rows, columns and inputs of one call.
inline constexpr int kMaxRows = 64;
inline constexpr int kMaxColumns = 128;
inline constexpr int kMaxBatch = 3;

/// sums[b][o] = bias[b * bias_stride + o] + sum over j of weights[o][j] * inputs[b][j].
/// \param bias_stride  0: one bias for all inputs
/// \param inputs  [batch][input_stride], each row 4-byte aligned
/// \pre 1 <= batch <= kMaxBatch; int8: columns is a multiple of 16, |sums| < 2^23; int16: inputs reach to
/// layer.stride, what lies beyond columns is arbitrary (its weights are 0)
void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]);
void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]);

namespace reference {
/// The same in plain words.
void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int8_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]);
void multiply(const Linear& layer, const std::int32_t* bias, int bias_stride, const std::int16_t* inputs,
              int input_stride, int batch, std::int32_t (*sums)[kMaxRows]);
}  // namespace reference

}  // namespace s4tp::satp
