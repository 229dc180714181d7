#pragma once
/// Refuses to run where the promise of identical bits cannot hold.

#include <cstdint>

#include "algo/core/status.hpp"

namespace s4tp {

/// What this processor and this build answer to questions whose right answer is known.
struct ArithmeticProbes {
  std::uint32_t denormal_bits;   ///< of the smallest normal float, halved: 0 where denormals are flushed
  std::uint32_t rounding_bits;   ///< of ties in both directions, combined: another value for other roundings
  std::uint32_t fused_bits;      ///< of a product minus its rounded self: not 0 where multiply-add is fused
  std::uint32_t functions_hash;  ///< FNV-1a over the results of math.hpp on fixed inputs
};

[[nodiscard]] ArithmeticProbes probe_arithmetic();

/// \return kOk when every answer is the right one, else kArithmetic
[[nodiscard]] Status status_of(const ArithmeticProbes& probes);

/// CORE-012 Probes denormals, rounding and fused multiply-add, then hashes our own functions on fixed inputs.
/// \return kOk, or kArithmetic
[[nodiscard]] Status arithmetic_self_test();

}  // namespace s4tp
