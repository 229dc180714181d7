#pragma once
/// Elementwise arithmetic of the network on Cortex-M with MVE: four or eight elements an instruction.
/// Internal: see lanes.hpp.

#include <arm_mve.h>

#include <cstdint>

#include "algo/satp/lanes_plain.hpp"

namespace s4tp::satp::mve {

inline void look_up(const Stretch* table, std::int16_t* values, int count) {
  const std::int16_t* starts = &table->value;
  const auto* rises = reinterpret_cast<const std::uint16_t*>(&table->rise);
  for (int i = 0; i < count; i += 8) {
    const uint16x8_t from_start =
        veorq_u16(vreinterpretq_u16_s16(vldrhq_s16(values + i)), vdupq_n_u16(0x8000U));
    const uint16x8_t index = vshlq_n_u16(vshrq_n_u16(from_start, 8), 1);  // in halves of a stretch
    const int16x8_t start = vldrhq_gather_shifted_offset_s16(starts, index);
    const uint16x8_t rise = vldrhq_gather_shifted_offset_u16(rises, index);
    // 2^8 times what is left of the stretch, so that the high half is rounded as wanted.
    const uint16x8_t climbed = vrmulhq_u16(rise, vshlq_n_u16(from_start, 8));
    vstrhq_s16(values + i, vaddq_s16(start, vreinterpretq_s16_u16(climbed)));
  }
}

inline void narrow(const std::int16_t* values, int count, std::int8_t* outputs) {
  for (int i = 0; i < count; i += 8) {
    const int8x16_t narrowed = vqrshrnbq_n_s16(vdupq_n_s8(0), vldrhq_s16(values + i), 8);
    vstrbq_s16(outputs + i, vreinterpretq_s16_s8(narrowed));
  }
}

inline void add_shares(const std::int16_t* shares, const std::int16_t* values, int count,
                       std::int16_t* sums) {
  for (int i = 0; i < count; i += 8) {
    const int16x8_t part = vqrdmulhq_s16(vldrhq_s16(shares + i), vldrhq_s16(values + i));
    vstrhq_s16(sums + i, vqaddq_s16(vldrhq_s16(sums + i), part));
  }
}

inline void blend(const std::int16_t* shares, const std::int16_t* others, int count, std::int16_t* values) {
  for (int i = 0; i < count; i += 8) {
    const int16x8_t share = vldrhq_s16(shares + i);
    const int16x8_t other = vldrhq_s16(others + i);
    const int16x8_t value = vldrhq_s16(values + i);
    const int32x4_t even = vsubq_s32(vmullbq_int_s16(share, value), vmullbq_int_s16(share, other));
    const int32x4_t odd = vsubq_s32(vmulltq_int_s16(share, value), vmulltq_int_s16(share, other));
    // May leave 16 bits; the sum comes back.
    const int16x8_t part = vrshrntq_n_s32(vrshrnbq_n_s32(value, even, 15), odd, 15);
    vstrhq_s16(values + i, vaddq_s16(other, part));
  }
}

inline void mix(const std::int16_t* values, const std::int16_t* others, std::int32_t share_q15,
                std::int32_t multiplier, int count, std::int8_t* outputs) {
  const int32x4_t by = vdupq_n_s32(multiplier);
  for (int i = 0; i < count; i += 8) {
    const int16x8_t part = vqrdmulhq_n_s16(vldrhq_s16(others + i), static_cast<std::int16_t>(share_q15));
    const uint16x8_t sum = vreinterpretq_u16_s16(vaddq_s16(vldrhq_s16(values + i), part));  // < 2^16
    const int32x4_t even = vrmulhq_s32(vreinterpretq_s32_u32(vshllbq_n_u16(sum, 8)), by);
    const int32x4_t odd = vrmulhq_s32(vreinterpretq_s32_u32(vshlltq_n_u16(sum, 8)), by);
    const uint16x8_t q = vqmovuntq_s32(vqmovunbq_s32(sum, even), odd);
    const uint8x16_t bytes = vqmovnbq_u16(vdupq_n_u8(0), q);
    vstrbq_u16(reinterpret_cast<std::uint8_t*>(outputs + i),
               veorq_u16(vreinterpretq_u16_u8(bytes), vdupq_n_u16(0x80)));
  }
}

inline void add_rescaled(const std::int8_t* values, std::int32_t multiplier, const std::int16_t* addends,
                         int count, std::int32_t* sums) {
  for (int i = 0; i < count; i += 4) {
    const int32x4_t q = vrmulhq_s32(vshlq_n_s32(vldrbq_s32(values + i), 8), vdupq_n_s32(multiplier));
    vstrwq_s32(sums + i, vaddq_s32(q, vldrhq_s32(addends + i)));
  }
}

inline std::uint64_t centre(std::int32_t* values, int count) {
  std::int32_t sum = 0;
  for (int i = 0; i < count; i += 4) sum = vaddvaq_s32(sum, vldrwq_s32(values + i));
  std::int64_t squares = 0;
  for (int i = 0; i < count; i += 4) {
    const int32x4_t centred = vsubq_n_s32(vmulq_n_s32(vldrwq_s32(values + i), count), sum);
    vstrwq_s32(values + i, centred);
    squares = vmlaldavaq_s32(squares, centred, centred);
  }
  return static_cast<std::uint64_t>(squares);
}

inline void scale(const std::int32_t* values, int shift, std::int32_t factor, const std::int32_t* gains,
                  const std::int32_t* biases, int count, std::int8_t* outputs) {
  for (int i = 0; i < count; i += 4) {
    const int32x4_t shifted = vshlq_r_s32(vldrwq_s32(values + i), shift);
    const int32x4_t scaled = vmulq_s32(vrmulhq_s32(shifted, vdupq_n_s32(factor)), vldrwq_s32(gains + i));
    const int32x4_t sum = vrshrq_n_s32(vqaddq_s32(scaled, vldrwq_s32(biases + i)), 20);
    const int16x8_t half = vqmovnbq_s32(vreinterpretq_s16_s32(sum), sum);
    vstrbq_s32(outputs + i, vreinterpretq_s32_s8(vqmovnbq_s16(vreinterpretq_s8_s16(half), half)));
  }
}

static_assert(kHeadWidth == 8, "a head is a vector of int16");

inline void score(const std::int8_t* query, Rows<const std::int8_t> keys, int count, std::int32_t* scores) {
  const int16x8_t asked = vldrbq_s16(query);
  const std::int8_t* key = keys.data;
  for (int j = 0; j < count; ++j, key += keys.stride) scores[j] = vmladavq_s16(asked, vldrbq_s16(key));
}

inline void weigh(const std::int32_t* weights, Rows<const std::int8_t> values, int count,
                  std::int32_t (&sums)[kHeadWidth]) {
  int32x4_t first = vdupq_n_s32(0);
  int32x4_t second = first;
  const std::int8_t* value = values.data;
  for (int j = 0; j < count; ++j, value += values.stride) {
    first = vmlaq_n_s32(first, vldrbq_s32(value), weights[j]);
    second = vmlaq_n_s32(second, vldrbq_s32(value + 4), weights[j]);
  }
  vstrwq_s32(sums, first);
  vstrwq_s32(sums + 4, second);
}

}  // namespace s4tp::satp::mve
