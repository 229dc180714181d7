#pragma once
/// Features to int16: divided by their unit, in 2^-13. Internal: for algo/satp's own sources.

#include <cstdint>

#include "algo/core/inline.hpp"
#include "algo/satp/network_input.hpp"

namespace s4tp::satp {

/// Columns, filled up to what the kernels read.
[[nodiscard]] constexpr int padded(int columns) {
  return (columns + 3) / 4 * 4;
}

/// \param row  padded(N) values; those beyond N are 0
template <int N>
void embed_features(const float (&features)[N], const float (&units)[N], std::int16_t* row) {
  constexpr float kOne = 8192.0F;
  for (int c = 0; c < N; ++c) {
    row[c] = static_cast<std::int16_t>(to_int(features[c] / units[c] * kOne, -32767, 32767));
  }
  for (int c = N; c < padded(N); ++c) row[c] = 0;
}

}  // namespace s4tp::satp
