#pragma once
/// What tests over DDS share: a domain of their own, and patience.

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

namespace s4tp::tests {

/// A domain nobody else has, `first` (0 .. 199) or one after it: a file says that it is taken until the process ends.
inline std::uint32_t claim_domain(std::uint32_t first) {
  constexpr std::uint32_t kDomains = 200;
  for (std::uint32_t i = 0; i < kDomains; ++i) {
    const std::uint32_t wanted = 20U + (first + i) % kDomains;
    const std::string file =
        std::filesystem::temp_directory_path() / ("s4tp_dds_domain_" + std::to_string(wanted));
    const int taken = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (taken >= 0 && flock(taken, LOCK_EX | LOCK_NB) == 0) return wanted;
    if (taken >= 0) close(taken);
  }
  throw std::runtime_error("no DDS domain is free");
}

/// One a test process.
inline std::uint32_t free_domain() {
  static const std::uint32_t domain = claim_domain(static_cast<std::uint32_t>(getpid()) % 200U);
  return domain;
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
