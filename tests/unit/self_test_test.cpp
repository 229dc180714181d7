#include "algo/core/self_test.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

namespace s4tp {

// CORE-010 CORE-012: this build on this processor gives the bits every target must give.
TEST(SelfTest, AcceptsThisProcessor) {
  EXPECT_EQ(arithmetic_self_test(), Status::kOk);
}

// CORE-004 CORE-012: one other bit in the hash of our functions is refused.
TEST(SelfTest, RefusesAnotherFunctionResult) {
  for (unsigned bit = 0; bit < 32U; ++bit) {
    ArithmeticProbes probes = probe_arithmetic();
    probes.functions_hash ^= 1U << bit;
    EXPECT_EQ(status_of(probes), Status::kArithmetic);
  }
}

// CORE-012: fused, (1 + 2^-12)^2 - (1 + 2^-11) leaves 2^-24 instead of 0.
TEST(SelfTest, RefusesFusedMultiplyAdd) {
  ArithmeticProbes probes = probe_arithmetic();
  EXPECT_EQ(probes.fused_bits, 0U);
  probes.fused_bits = std::bit_cast<std::uint32_t>(5.9604644775390625e-08F);
  EXPECT_EQ(status_of(probes), Status::kArithmetic);
}

// CORE-012: where denormals are flushed, half of the smallest normal float is 0.
TEST(SelfTest, RefusesFlushedDenormals) {
  ArithmeticProbes probes = probe_arithmetic();
  probes.denormal_bits = 0U;
  EXPECT_EQ(status_of(probes), Status::kArithmetic);
}

// CORE-012: rounding towards zero gives 1 + 3 * 2^-24 = 1 + 2^-23, one bit below the tie's even neighbour.
TEST(SelfTest, RefusesAnotherRounding) {
  ArithmeticProbes probes = probe_arithmetic();
  probes.rounding_bits = 0x3F800001U ^ 0x3F800002U;
  EXPECT_EQ(status_of(probes), Status::kArithmetic);
}

}  // namespace s4tp
