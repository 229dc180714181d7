// The core's assertion for callers in C. A member of its own in the archive: a program that defines
// s4tp::assertion_failed() itself never gets this one, and owes no s4tp_on_assertion().

#include "algo/api/s4tp.h"
#include "algo/core/check.hpp"

void s4tp::assertion_failed(const char* expression, const char* file, int line) {
  for (;;) s4tp_on_assertion(expression, file, line);
}
