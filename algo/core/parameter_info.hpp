#pragma once
/// What the table says of each parameter: for files, documentation and whoever asks by name. An image that asks for none of
/// it does not carry its words.

#include "algo/core/parameters.hpp"

namespace s4tp {

/// One row of the table.
struct ParameterInfo {
  const char* name;  ///< "group.field"
  const char* unit;
  float initial;
  float minimum;
  float maximum;
  const char* meaning;
};

/// The row of field `index` in struct order. \pre 0 <= index < kParameterCount
[[nodiscard]] const ParameterInfo& parameter_info(int index);
/// \return the index of "group.field", or -1
[[nodiscard]] int find_parameter(const char* name);

}  // namespace s4tp
