#include "algo/core/parameters.hpp"

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "algo/core/check.hpp"
#include "algo/core/crc32.hpp"
#include "algo/core/inline.hpp"
#include "algo/core/versions.hpp"

namespace s4tp {
namespace {

struct Bounds {
  float minimum;
  float maximum;
};

constexpr Bounds kBounds[] = {
#define GROUP_BEGIN(group)
#define P(group, field, unit, initial, minimum, maximum, meaning) {minimum, maximum},
#define GROUP_END(group)
#include "algo/core/parameters.def"
#undef GROUP_BEGIN
#undef P
#undef GROUP_END
};

static_assert(sizeof(kBounds) / sizeof(kBounds[0]) == static_cast<std::size_t>(kParameterCount));
static_assert(std::is_standard_layout_v<Parameters> && std::is_trivially_copyable_v<Parameters>);

/// Byte offset of field `index`: the struct holds floats only, in table order.
std::size_t offset_of(int index) {
  S4TP_ASSERT(index >= 0 && index < kParameterCount);
  return static_cast<std::size_t>(index) * sizeof(float);
}

}  // namespace

float get_parameter(const Parameters& parameters, int index) {
  float value = 0.0F;
  std::memcpy(&value, reinterpret_cast<const unsigned char*>(&parameters) + offset_of(index), sizeof(value));
  return value;
}

void set_parameter(Parameters& parameters, int index, float value) {
  std::memcpy(reinterpret_cast<unsigned char*>(&parameters) + offset_of(index), &value, sizeof(value));
}

Status validate(const Parameters& parameters, int& first_bad) {
  for (int i = 0; i < kParameterCount; ++i) {
    const float value = get_parameter(parameters, i);
    if (!is_finite(value) || value < kBounds[i].minimum || value > kBounds[i].maximum) {
      first_bad = i;
      return Status::kInvalidParameter;
    }
  }
  return Status::kOk;
}

std::uint32_t parameters_crc(const Parameters& parameters) {
  std::uint32_t crc = crc32_byte(kCrc32Start, kParametersVersion);
  for (int i = 0; i < kParameterCount; ++i) {
    const float value = get_parameter(parameters, i);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    crc = crc32_word(crc, bits);
  }
  return crc ^ 0xFFFFFFFFU;
}

}  // namespace s4tp
