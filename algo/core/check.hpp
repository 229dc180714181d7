#pragma once
/// Assertions, for our own faults only: bad input is answered with a Status, never with an assertion.

namespace s4tp {

/// Called when one of our own invariants is broken. The application defines it: a target resets through its
/// watchdog, the host prints and aborts. It does not return.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);

}  // namespace s4tp

#define S4TP_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::s4tp::assertion_failed(#expression, __FILE__, __LINE__))
