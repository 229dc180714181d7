#pragma once
/// How often a topic's messages are taken.

#include <cstdint>

namespace s4tp::telemetry {

/// TELE-043 A topic's messages are taken 40 ms apart. While more than 25 come in a second, none
/// is, until a second has passed in which fewer came. The first of a flood is taken: nobody knows it yet.
class RateGuard {
 public:
  static constexpr std::uint32_t kApartMs = 40;
  static constexpr std::uint32_t kWindowMs = 1000;
  static constexpr std::uint32_t kMostInWindow = 25;

  [[nodiscard]] bool admits(std::uint32_t now_ms) {
    const std::uint32_t passed_ms = now_ms - window_ms_;
    if (!begun_ || passed_ms >= kWindowMs) {
      flooded_ = begun_ && passed_ms < 2 * kWindowMs && count_ > kMostInWindow;
      window_ms_ = now_ms;
      count_ = 0;
    }
    flooded_ = ++count_ > kMostInWindow || flooded_;
    if (flooded_ || (begun_ && now_ms - admitted_ms_ < kApartMs)) return false;
    begun_ = true;
    admitted_ms_ = now_ms;
    return true;
  }

 private:
  bool begun_ = false;
  bool flooded_ = false;
  std::uint32_t window_ms_ = 0;
  std::uint32_t count_ = 0;
  std::uint32_t admitted_ms_ = 0;
};

}  // namespace s4tp::telemetry
