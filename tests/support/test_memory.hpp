#pragma once
/// Names of shared memory for tests, one a process and use.

#include <errno.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace s4tp::tests {

/// "/s4tp_test_WHAT_PID". A test that was killed could not remove its own: what belongs to no living process
/// is removed here.
inline std::string test_memory(const std::string& what) {
  const std::string prefix = "s4tp_test_";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    const std::string name = entry.path().filename();
    if (name.rfind(prefix, 0) != 0) continue;
    const int process = std::atoi(name.c_str() + name.rfind('_') + 1);
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH)
      std::filesystem::remove(entry.path(), ignored);
  }
  return "/" + prefix + what + "_" + std::to_string(getpid());
}

}  // namespace s4tp::tests
