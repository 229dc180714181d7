#pragma once
/// A kernel that grants what a test lets it, and whose files a test writes.

#include <cerrno>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "hal/linux/realtime.hpp"

namespace s4tp::hal::linux_host {

class FakeKernel final : public RealtimeKernel {
 public:
  int set_fifo(int priority) override {
    const std::lock_guard lock(mutex_);
    asked_priorities.push_back(priority);
    return fifo_error;
  }
  int lock_memory(bool with_future) override {
    future = with_future;
    return memory_error;
  }
  std::uint64_t limit(Right right) override { return right == Right::kNice ? rtprio : memlock; }
  bool has(Right) override { return privileged; }
  bool read(const char* path, char* text, int size) override {
    const auto file = files.find(path);
    if (file == files.end()) return false;
    std::snprintf(text, static_cast<std::size_t>(size), "%s", file->second.c_str());
    return true;
  }

  int fifo_error = EPERM;
  int memory_error = ENOMEM;
  std::uint64_t rtprio = 0;
  std::uint64_t memlock = 8 * 1024 * 1024;
  bool privileged = false;
  bool future = false;
  std::vector<int> asked_priorities;
  std::map<std::string, std::string> files;

 private:
  std::mutex mutex_;  // two threads ask
};

}  // namespace s4tp::hal::linux_host
