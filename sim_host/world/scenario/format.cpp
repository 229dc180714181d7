#include "sim_host/world/scenario/format.hpp"

#include <cstdarg>
#include <cstdio>

namespace s4tp::scenario {

std::string format(const char* pattern, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace s4tp::scenario
