#include "algo/core/self_test.hpp"

#include <cstring>

#include "algo/core/inline.hpp"

namespace s4tp {
namespace {

constexpr std::uint32_t kHalfOfSmallestNormal = 0x00400000U;
constexpr std::uint32_t kRounding = 0U;
/// Changes whenever a function of math.hpp gives another bit anywhere on the inputs below.
constexpr std::uint32_t kFunctionsHash = 0x842E1660U;

std::uint32_t bits_of(float x) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return bits;
}

/// The value, hidden from the compiler: what follows is computed by the processor, at run time.
float at_run_time(float x) {
  volatile float hidden = x;
  return hidden;
}

std::uint32_t hash(std::uint32_t seed, float value) {
  const std::uint32_t bits = bits_of(value);
  for (unsigned shift = 0; shift < 32U; shift += 8U) seed = (seed ^ ((bits >> shift) & 0xFFU)) * 16777619U;
  return seed;
}

std::uint32_t probe_rounding() {
  constexpr float kHalfUlp = 5.9604644775390625e-08F;  // 2^-24, half of the spacing above 1
  const float one = at_run_time(1.0F);
  const float half_ulp = at_run_time(kHalfUlp);
  const float up = one + half_ulp;           // 1: the tie goes to even
  const float down = -one - half_ulp;        // -1
  const float even = one + 3.0F * half_ulp;  // 1 + 2^-22: the other neighbour is odd
  return (bits_of(up) ^ 0x3F800000U) | (bits_of(down) ^ 0xBF800000U) | (bits_of(even) ^ 0x3F800002U);
}

std::uint32_t probe_fused() {
  // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24 rounds to 1 + 2^-11; fused, the 2^-24 survives.
  const float factor = at_run_time(1.000244140625F);
  const float addend = at_run_time(-1.00048828125F);
  return bits_of(factor * factor + addend);
}

std::uint32_t hash_functions() {
  std::uint32_t seed = 2166136261U;
  for (int i = -64; i <= 64; ++i) {
    const float x = at_run_time(static_cast<float>(i) * 0.1171875F + 0.0078125F);
    seed = hash(seed, sqrt(x));
    seed = hash(seed, exp(x));
    seed = hash(seed, erf(0.5F * x));
    seed = hash(seed, sin(100.0F * x));
    seed = hash(seed, cos(100.0F * x));
    seed = hash(seed, tan(0.1875F * x));
    seed = hash(seed, atan(x));
    seed = hash(seed, atan2(x, 1.0F - x));
    seed = hash(seed, tanh(x));
    seed = hash(seed, floor(x));
    seed = hash(seed, wrap_angle(100.0F * x));
    seed = hash(seed, 1.0F / x);
  }
  return seed;
}

}  // namespace

ArithmeticProbes probe_arithmetic() {
  return {bits_of(at_run_time(1.17549435e-38F) * at_run_time(0.5F)), probe_rounding(), probe_fused(),
          hash_functions()};
}

Status status_of(const ArithmeticProbes& probes) {
  const bool exact = probes.denormal_bits == kHalfOfSmallestNormal && probes.rounding_bits == kRounding &&
                     probes.fused_bits == 0U && probes.functions_hash == kFunctionsHash;
  return exact ? Status::kOk : Status::kArithmetic;
}

Status arithmetic_self_test() {
  return status_of(probe_arithmetic());
}

}  // namespace s4tp
