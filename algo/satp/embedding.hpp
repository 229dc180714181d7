#pragma once
/// Features to int16: divided by their unit, in 2^-13. Internal: for algo/satp's own sources.

#include <cstdint>
#include <cstring>

#include "algo/core/inline.hpp"
#include "algo/satp/network_input.hpp"

namespace s4tp::satp {

/// Columns, filled up to what the kernels read.
[[nodiscard]] constexpr int padded(int columns) {
  return (columns + 3) / 4 * 4;
}

/// To the nearest integer, halves to the even one; within +-32767, and -32767 where it is not a number.
[[nodiscard]] inline std::int32_t to_q15(float x) {
#if defined(__ARM_FEATURE_DSP) && defined(__thumb__) && defined(__ARM_FP)
  // Cortex-M7 and M55. The larger one of a number and of what is none is the number.
  float whole = 0.0F;
  asm("vmaxnm.f32 %0, %1, %2\n"
      "vminnm.f32 %0, %0, %3\n"
      "vcvtn.s32.f32 %0, %0"
      : "=&t"(whole)
      : "t"(x), "t"(-32767.0F), "t"(32767.0F));
  std::int32_t result = 0;
  std::memcpy(&result, &whole, sizeof result);
  return result;
#else
  return to_int(x, -32767, 32767);
#endif
}

/// \param row  padded(N) values; those beyond N are 0
template <int N>
void embed_features(const float (&features)[N], const float (&units)[N], std::int16_t* row) {
  constexpr float kOne = 8192.0F;
#pragma GCC unroll 12
  for (int c = 0; c < N; ++c) row[c] = static_cast<std::int16_t>(to_q15(features[c] / units[c] * kOne));
  for (int c = N; c < padded(N); ++c) row[c] = 0;
}

}  // namespace s4tp::satp
