#pragma once
/// Elementwise arithmetic of the network in plain words, and what all processors agree on.
/// Internal: see lanes.hpp.

#include <cstdint>

#include "algo/satp/network_shape.hpp"
#include "algo/satp/requantize.hpp"
#include "algo/satp/rows.hpp"

namespace s4tp::satp {

/// Where one of a table's 256 stretches begins, and how far it rises: one word to load.
struct Stretch {
  std::int16_t value;
  std::int16_t rise;  ///< 0 .. 2^15 - 1
};

inline constexpr int kHeadWidth = kMcuShape.width / kMcuShape.heads;  ///< columns of an attention's head

namespace plain {

// Product of a value and a share in 2^-15.
inline std::int32_t share_of(std::int32_t share_q15, std::int32_t value) {
  return (share_q15 * value + (1 << 14)) >> 15;
}

/// values = table, linear between its stretches, at the values.
inline void look_up(const Stretch* table, std::int16_t* values, int count) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t from_start = values[i] + 32768;
    const Stretch& stretch = table[from_start >> 8];
    values[i] = static_cast<std::int16_t>(stretch.value + ((stretch.rise * (from_start & 255) + 128) >> 8));
  }
}

/// outputs = values / 256, to nearest.
inline void narrow(const std::int16_t* values, int count, std::int8_t* outputs) {
  for (int i = 0; i < count; ++i) outputs[i] = static_cast<std::int8_t>(saturate8((values[i] + 128) >> 8));
}

/// sums += shares * values, saturated. \param shares  0 .. 1 in 2^-15
inline void add_shares(const std::int16_t* shares, const std::int16_t* values, int count,
                       std::int16_t* sums) {
  for (int i = 0; i < count; ++i)
    sums[i] = static_cast<std::int16_t>(saturate16(sums[i] + share_of(shares[i], values[i])));
}

/// values = (1 - shares) * others + shares * values
inline void blend(const std::int16_t* shares, const std::int16_t* others, int count, std::int16_t* values) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t other = others[i];
    values[i] = static_cast<std::int16_t>(other + share_of(shares[i], values[i] - other));
  }
}

/// outputs = requantize(values + share * others), as behind a ReLU. \pre values, others >= 0
inline void mix(const std::int16_t* values, const std::int16_t* others, std::int32_t share_q15,
                std::int32_t multiplier, int count, std::int8_t* outputs) {
  for (int i = 0; i < count; ++i) {
    const std::int32_t sum = values[i] + share_of(share_q15, others[i]);
    outputs[i] = static_cast<std::int8_t>(saturate_unsigned8(requantize(sum, multiplier)) - 128);
  }
}

/// sums = requantize(values) + addends
inline void add_rescaled(const std::int8_t* values, std::int32_t multiplier, const std::int16_t* addends,
                         int count, std::int32_t* sums) {
  for (int i = 0; i < count; ++i) sums[i] = requantize(values[i], multiplier) + addends[i];
}

/// values = count * values - their sum \return the sum of their squares
inline std::uint64_t centre(std::int32_t* values, int count) {
  std::int32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += values[i];
  std::uint64_t squares = 0;
  for (int i = 0; i < count; ++i) {
    values[i] = count * values[i] - sum;
    squares += static_cast<std::uint64_t>(static_cast<std::int64_t>(values[i]) * values[i]);
  }
  return squares;
}

/// outputs = (gains * requantize_wide(values << shift, factor) + biases) / 2^20, to nearest.
/// Gain and bias are bounded, their sum with a half is not: it saturates.
inline void scale(const std::int32_t* values, int shift, std::int32_t factor, const std::int32_t* gains,
                  const std::int32_t* biases, int count, std::int8_t* outputs) {
  constexpr int kBits = 20;
  for (int i = 0; i < count; ++i) {
    const std::int32_t scaled = requantize_wide(values[i] * (1 << shift), factor) * gains[i];
    const std::int32_t sum = saturating_sum(saturating_sum(scaled, biases[i]), 1 << (kBits - 1));
    outputs[i] = static_cast<std::int8_t>(saturate8(sum >> kBits));
  }
}

/// scores[j] = query times keys[j], over kHeadWidth columns.
inline void score(const std::int8_t* query, Rows<const std::int8_t> keys, int count, std::int32_t* scores) {
  for (int j = 0; j < count; ++j) {
    std::int32_t sum = 0;
    for (int c = 0; c < kHeadWidth; ++c) sum += query[c] * keys[j][c];
    scores[j] = sum;
  }
}

/// sums = weights times values, over kHeadWidth columns. \param weights  0 .. 2^15 - 1
inline void weigh(const std::int32_t* weights, Rows<const std::int8_t> values, int count,
                  std::int32_t (&sums)[kHeadWidth]) {
  for (std::int32_t& sum : sums) sum = 0;
  for (int j = 0; j < count; ++j) {
    for (int c = 0; c < kHeadWidth; ++c) sums[c] += weights[j] * values[j][c];
  }
}

}  // namespace plain
}  // namespace s4tp::satp
