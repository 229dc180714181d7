#pragma once
/// What tests over DDS share: a domain of their own, and patience.

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

namespace s4tp::tests {

/// One a test process.
inline std::uint32_t free_domain() {
  return 20U + static_cast<std::uint32_t>(getpid()) % 200U;
}

inline bool wait_for(const std::function<bool()>& holds,
                     std::chrono::milliseconds most = std::chrono::seconds(20)) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace s4tp::tests
