#include "algo/core/parameter_info.hpp"

#include <cstddef>
#include <cstring>

#include "algo/core/check.hpp"

namespace s4tp {
namespace {

constexpr ParameterInfo kTable[] = {
#define GROUP_BEGIN(group)
#define P(group, field, unit, initial, minimum, maximum, meaning) \
  {#group "." #field, unit, initial, minimum, maximum, meaning},
#define GROUP_END(group)
#include "algo/core/parameters.def"
#undef GROUP_BEGIN
#undef P
#undef GROUP_END
};

static_assert(sizeof(kTable) / sizeof(kTable[0]) == static_cast<std::size_t>(kParameterCount));

}  // namespace

const ParameterInfo& parameter_info(int index) {
  S4TP_ASSERT(index >= 0 && index < kParameterCount);
  return kTable[index];
}

int find_parameter(const char* name) {
  for (int i = 0; i < kParameterCount; ++i) {
    if (std::strcmp(kTable[i].name, name) == 0) return i;
  }
  return -1;
}

}  // namespace s4tp
