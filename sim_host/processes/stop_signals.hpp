#pragma once
/// SIGINT and SIGTERM end a process in order.

#include <atomic>

namespace s4tp::processes {

/// Set by either signal from this call on.
[[nodiscard]] const std::atomic<bool>& stop_on_signals();

}  // namespace s4tp::processes
