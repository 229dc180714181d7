#pragma once
/// Refuses to run where the promise of identical bits cannot hold.

#include "algo/core/status.hpp"

namespace s4tp {

/// CORE-012 Probes denormals, rounding and fused multiply-add, then hashes our own functions on fixed inputs.
/// \return kOk, or kArithmetic
[[nodiscard]] Status arithmetic_self_test();

}  // namespace s4tp
