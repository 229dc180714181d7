#pragma once
/// From accumulators back to activations: the one rounding rule of the network.
///
///     q = floor((accumulator * multiplier + half) / 2^shift), half = 2^(shift - 1): to nearest, halves up
///
/// shift is 24 behind int8 inputs (|accumulator| < 2^23, so multipliers reach 128) and 32 behind int16
/// inputs. Internal: for algo/satp's own sources.

#include <cstdint>

namespace s4tp::satp {

/// \pre |accumulator| < 2^23, 0 <= multiplier
[[nodiscard]] inline std::int32_t requantize(std::int32_t accumulator, std::int32_t multiplier) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  // The same product 256 times as large: its high half, rounded, is one instruction.
  std::int32_t result = 0;
  const std::int32_t shifted = accumulator * 256;
  asm("smmulr %0, %1, %2" : "=r"(result) : "r"(shifted), "r"(multiplier));
  return result;
#else
  return static_cast<std::int32_t>((static_cast<std::int64_t>(accumulator) * multiplier + (1 << 23)) >> 24);
#endif
}

/// \pre 0 <= multiplier
[[nodiscard]] inline std::int32_t requantize_wide(std::int32_t accumulator, std::int32_t multiplier) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  std::int32_t result = 0;
  asm("smmulr %0, %1, %2" : "=r"(result) : "r"(accumulator), "r"(multiplier));
  return result;
#else
  constexpr std::int64_t kHalf = std::int64_t{1} << 31;
  return static_cast<std::int32_t>((static_cast<std::int64_t>(accumulator) * multiplier + kHalf) >> 32);
#endif
}

/// a + b, no further than int32 goes.
[[nodiscard]] inline std::int32_t saturating_sum(std::int32_t a, std::int32_t b) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  std::int32_t result = 0;
  asm("qadd %0, %1, %2" : "=r"(result) : "r"(a), "r"(b));
  return result;
#else
  const std::int64_t sum = static_cast<std::int64_t>(a) + b;
  return static_cast<std::int32_t>(sum < INT32_MIN ? INT32_MIN : (sum > INT32_MAX ? INT32_MAX : sum));
#endif
}

/// To the range of int8, of int16, and of a byte without sign.
[[nodiscard]] inline std::int32_t saturate8(std::int32_t x) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  asm("ssat %0, #8, %0" : "+r"(x));
  return x;
#else
  return x < -128 ? -128 : (x > 127 ? 127 : x);
#endif
}
[[nodiscard]] inline std::int32_t saturate16(std::int32_t x) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  asm("ssat %0, #16, %0" : "+r"(x));
  return x;
#else
  return x < -32768 ? -32768 : (x > 32767 ? 32767 : x);
#endif
}
[[nodiscard]] inline std::int32_t saturate_unsigned8(std::int32_t x) {
#if defined(__ARM_FEATURE_DSP) && __ARM_FEATURE_DSP && defined(__thumb__)
  asm("usat %0, #8, %0" : "+r"(x));
  return x;
#else
  return x < 0 ? 0 : (x > 255 ? 255 : x);
#endif
}

}  // namespace s4tp::satp
