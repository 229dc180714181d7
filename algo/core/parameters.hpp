#pragma once
/// Run-time values of the core: one standard-layout struct, made from parameters.def.

#include <cstdint>

#include "algo/core/status.hpp"

namespace s4tp {

/// All fields are float, so the struct is also an array of kParameterCount floats in table order.
struct Parameters {
// NOLINTBEGIN(bugprone-macro-parentheses): arguments that are names stand as they are
#define GROUP_BEGIN(group) struct {
#define P(group, field, unit, initial, minimum, maximum, meaning) float field = initial;
#define GROUP_END(group) \
  }                      \
  group;
// NOLINTEND(bugprone-macro-parentheses)
#include "algo/core/parameters.def"
#undef GROUP_BEGIN
#undef P
#undef GROUP_END
};

inline constexpr int kParameterCount = static_cast<int>(sizeof(Parameters) / sizeof(float));

/// Of field `index` in struct order. \pre 0 <= index < kParameterCount
[[nodiscard]] float get_parameter(const Parameters& parameters, int index);
void set_parameter(Parameters& parameters, int index, float value);

/// CORE-020 Every field finite and inside its range.
/// \param first_bad  receives the index of the first field that is not, when the answer is kInvalidParameter
[[nodiscard]] Status validate(const Parameters& parameters, int& first_bad);

/// CRC-32 (IEEE 802.3, reflected) over the version and the bits of every field, little endian (CORE-021).
[[nodiscard]] std::uint32_t parameters_crc(const Parameters& parameters);

}  // namespace s4tp
