#pragma once
/// LayerNorm with integer statistics.

#include <cstdint>

#include "algo/satp/weight_image.hpp"

namespace s4tp::satp {

/// outputs = gain * (values - mean) / deviation + bias over kMcuShape.width values, int8. SATP-024 Scaling or
/// shifting all values changes nothing but rounding; equal values give the bias.
/// \param values  are used up \pre |values| < 2^17
void layer_norm(const Norm& norm, std::int32_t* values, std::int8_t* outputs);

/// floor(sqrt(x))
[[nodiscard]] std::uint32_t integer_sqrt(std::uint32_t x);

}  // namespace s4tp::satp
