// What the host does when one of our own invariants is broken: say where, and stop at once.

#include <cstdio>
#include <cstdlib>

#include "algo/core/check.hpp"

namespace s4tp {

void assertion_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: internal fault: %s does not hold\n", file, line, expression);
  std::abort();
}

}  // namespace s4tp
