#pragma once
/// Elementwise arithmetic of the network on Cortex-M with the DSP extension: two int16 in a word.
/// Internal: see lanes.hpp.

#include <cstdint>
#include <cstring>

#include "algo/satp/lanes_plain.hpp"

namespace s4tp::satp::dsp {

using plain::add_rescaled;
using plain::centre;
using plain::scale;

inline std::int32_t load_pair(const std::int16_t* from) {
  std::int32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}
inline void store_pair(std::int16_t* to, std::int32_t word) {
  std::memcpy(to, &word, sizeof word);
}

// The low half of `low` beside that of `high`.
inline std::int32_t pair_of(std::int32_t low, std::int32_t high) {
  std::int32_t result = 0;
  asm("pkhbt %0, %1, %2, lsl #16" : "=r"(result) : "r"(low), "r"(high));
  return result;
}

// Two numbers in 2^-15, to whole ones.
inline std::int32_t whole_pair(std::int32_t low_q15, std::int32_t high_q15) {
  std::int32_t result = 0;
  asm("pkhbt %0, %1, %2, lsl #1" : "=r"(result) : "r"(low_q15 >> 15), "r"(high_q15));
  return result;
}

constexpr std::int32_t kHalfQ15 = 1 << 14;

inline void look_up(const Stretch* table, std::int16_t* values, int count) {
  static_assert(sizeof(Stretch) == 4);
  constexpr std::uint32_t kFromStart = 0x80008000U;
#pragma GCC unroll 2
  for (int i = 0; i < count; i += 2) {
    const std::uint32_t from_start = static_cast<std::uint32_t>(load_pair(values + i)) ^ kFromStart;
    const std::int32_t low = load_pair(&table[from_start >> 8U & 255U].value);
    const std::int32_t high = load_pair(&table[from_start >> 24U].value);
    const std::int32_t low_climb =
        __builtin_arm_smlatb(low, static_cast<std::int32_t>(from_start & 255U), 128);
    const std::int32_t high_climb =
        __builtin_arm_smlatb(high, static_cast<std::int32_t>(from_start >> 16U & 255U), 128);
    store_pair(values + i, pair_of(low + (low_climb >> 8), high + (high_climb >> 8)));
  }
}

inline void narrow(const std::int16_t* values, int count, std::int8_t* outputs) {
  constexpr std::int32_t kHalves = 0x00800080;
#pragma GCC unroll 2
  for (int i = 0; i < count; i += 2) {
    const std::int32_t rounded = __builtin_arm_qadd16(load_pair(values + i), kHalves);
    outputs[i] = static_cast<std::int8_t>(rounded >> 8);
    outputs[i + 1] = static_cast<std::int8_t>(rounded >> 24);
  }
}

inline void add_shares(const std::int16_t* shares, const std::int16_t* values, int count,
                       std::int16_t* sums) {
#pragma GCC unroll 2
  for (int i = 0; i < count; i += 2) {
    const std::int32_t share = load_pair(shares + i);
    const std::int32_t value = load_pair(values + i);
    const std::int32_t part = whole_pair(__builtin_arm_smlabb(share, value, kHalfQ15),
                                         __builtin_arm_smlatt(share, value, kHalfQ15));
    store_pair(sums + i, __builtin_arm_qadd16(load_pair(sums + i), part));
  }
}

inline void blend(const std::int16_t* shares, const std::int16_t* others, int count, std::int16_t* values) {
#pragma GCC unroll 2
  for (int i = 0; i < count; i += 2) {
    const std::int32_t share = load_pair(shares + i);
    const std::int32_t other = load_pair(others + i);
    const std::int32_t value = load_pair(values + i);
    const std::int32_t low = __builtin_arm_smlabb(share, value, kHalfQ15) -
                             static_cast<std::int16_t>(share) * static_cast<std::int16_t>(other);
    const std::int32_t high = __builtin_arm_smlatt(share, value, kHalfQ15) - (share >> 16) * (other >> 16);
    // What is added may leave 16 bits; the sum comes back.
    store_pair(values + i, __builtin_arm_sadd16(other, whole_pair(low, high)));
  }
}

inline void mix(const std::int16_t* values, const std::int16_t* others, std::int32_t share_q15,
                std::int32_t multiplier, int count, std::int8_t* outputs) {
#pragma GCC unroll 2
  for (int i = 0; i < count; i += 2) {
    const std::int32_t value = load_pair(values + i);
    const std::int32_t other = load_pair(others + i);
    const std::int32_t low = (value & 0xFFFF) + (__builtin_arm_smlabb(share_q15, other, kHalfQ15) >> 15);
    const std::int32_t high = (value >> 16) + (__builtin_arm_smlatb(other, share_q15, kHalfQ15) >> 15);
    outputs[i] = static_cast<std::int8_t>(saturate_unsigned8(requantize(low, multiplier)) - 128);
    outputs[i + 1] = static_cast<std::int8_t>(saturate_unsigned8(requantize(high, multiplier)) - 128);
  }
}

static_assert(kHeadWidth == 8, "a head is two words");

inline std::int32_t load_four(const std::int8_t* from) {
  std::int32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}
inline std::int32_t even_bytes(std::int32_t word) {
  return __builtin_arm_sxtb16(word);
}
inline std::int32_t odd_bytes(std::int32_t word) {
  std::int32_t result = 0;
  asm("sxtb16 %0, %1, ror #8" : "=r"(result) : "r"(word));
  return result;
}

inline void score(const std::int8_t* query, Rows<const std::int8_t> keys, int count, std::int32_t* scores) {
  const std::int32_t first = load_four(query);
  const std::int32_t second = load_four(query + 4);
  const std::int32_t first_even = even_bytes(first);
  const std::int32_t first_odd = odd_bytes(first);
  const std::int32_t second_even = even_bytes(second);
  const std::int32_t second_odd = odd_bytes(second);
  const std::int8_t* key = keys.data;
  for (int j = 0; j < count; ++j, key += keys.stride) {
    const std::int32_t low = load_four(key);
    const std::int32_t high = load_four(key + 4);
    std::int32_t sum = __builtin_arm_smuad(first_even, even_bytes(low));
    sum = __builtin_arm_smlad(first_odd, odd_bytes(low), sum);
    sum = __builtin_arm_smlad(second_even, even_bytes(high), sum);
    scores[j] = __builtin_arm_smlad(second_odd, odd_bytes(high), sum);
  }
}

inline void weigh(const std::int32_t* weights, Rows<const std::int8_t> values, int count,
                  std::int32_t (&sums)[kHeadWidth]) {
  for (int half = 0; half < kHeadWidth; half += 4) {
    std::int32_t s0 = 0;
    std::int32_t s1 = 0;
    std::int32_t s2 = 0;
    std::int32_t s3 = 0;
    const std::int8_t* value = values.data + half;
    for (int j = 0; j < count; ++j, value += values.stride) {
      const std::int32_t four = load_four(value);
      const std::int32_t even = even_bytes(four);
      const std::int32_t odd = odd_bytes(four);
      s0 = __builtin_arm_smlabb(weights[j], even, s0);
      s1 = __builtin_arm_smlabb(weights[j], odd, s1);
      s2 = __builtin_arm_smlatb(even, weights[j], s2);
      s3 = __builtin_arm_smlatb(odd, weights[j], s3);
    }
    sums[half] = s0;
    sums[half + 1] = s1;
    sums[half + 2] = s2;
    sums[half + 3] = s3;
  }
}

}  // namespace s4tp::satp::dsp
