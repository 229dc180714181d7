#pragma once
/// When to tell a controller to leave bus-off: 100 ms after it got there, then at doubled intervals up to 1.6
/// s, for as long as it takes. ISO 11898-1's own 128 x 11 recessive bits (3 ms at 500 kbit/s) are over by
/// then.

#include <cstdint>

namespace s4tp::hal::linux_host {

class RestartPolicy {
 public:
  /// Bus-off was reported.
  void begin(std::uint64_t now_ms) {
    if (running_) return;
    running_ = true;
    interval_ms_ = kFirstMs;
    due_ms_ = now_ms + interval_ms_;
  }
  /// The controller is well again.
  void end() { running_ = false; }
  /// LINUX-010 \return whether a restart is due now; asking takes it
  [[nodiscard]] bool due(std::uint64_t now_ms) {
    if (!running_ || now_ms < due_ms_) return false;
    if (interval_ms_ < kLongestMs) interval_ms_ *= 2;
    due_ms_ = now_ms + interval_ms_;
    return true;
  }

 private:
  static constexpr std::uint64_t kFirstMs = 100;
  static constexpr std::uint64_t kLongestMs = 1600;
  bool running_ = false;
  std::uint64_t interval_ms_ = kFirstMs;
  std::uint64_t due_ms_ = 0;
};

}  // namespace s4tp::hal::linux_host
