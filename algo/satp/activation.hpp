#pragma once
/// Sigmoid and tanh by table, 256 stretches over -8 .. 8, linear between.
/// SATP-022 Within 2e-4 (sigmoid) and 6e-4 (tanh) of the real function, never falling, odd or point-symmetric
/// up to the last place.

#include <cstdint>

namespace s4tp::satp {

/// \param x_q12  in 2^-12  \return in 2^-15; 1 is 32767
[[nodiscard]] std::int16_t sigmoid_q15(std::int16_t x_q12);
[[nodiscard]] std::int16_t tanh_q15(std::int16_t x_q12);
/// Of `count` values in place, a multiple of 8.
void sigmoid_q15(std::int16_t* values, int count);
void tanh_q15(std::int16_t* values, int count);

/// exp(-x): 2^-15. \param x_q8  in 2^-8, >= 0; 0 from 16 on
[[nodiscard]] std::int32_t exp_minus_q15(std::int32_t x_q8);

}  // namespace s4tp::satp
