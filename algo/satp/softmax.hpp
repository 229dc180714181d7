#pragma once
/// Softmax over the scores of an attention's keys, masked.

#include <cstdint>

namespace s4tp::satp {

inline constexpr int kMaxKeys = 17;

/// weights[j] = exp(scores[j] - largest), in 2^-15; 0 where masked. SATP-023 The weights divided by their sum
/// are within 0.004 of the real softmax; the largest score's weight is one.
/// \param mask  bit j: key j is there  \param multiplier  from a score to its argument in 2^-8, see
/// requantize \return their sum; 0 when no key is there \pre 0 <= count <= kMaxKeys; scores of unmasked keys
/// differ by less than 2^23
[[nodiscard]] std::int32_t softmax(const std::int32_t* scores, int count, std::uint32_t mask,
                                   std::int32_t multiplier, std::int32_t* weights);

}  // namespace s4tp::satp
