#pragma once
/// Local time of a simulation: it stands still until vehicle time moves it.

#include <cstdint>

#include "hal/clock.hpp"

namespace s4tp::hal::sim {

class SimClock final : public Clock {
 public:
  /// HAL-011 Follows vehicle time and never runs back.
  void follow(std::uint32_t vehicle_time_ms) {
    const std::uint64_t time_us = std::uint64_t{vehicle_time_ms} * 1000U;
    if (time_us > now_us_) now_us_ = time_us;
  }
  [[nodiscard]] std::uint64_t now_us() const override { return now_us_; }

 private:
  std::uint64_t now_us_ = 0;
};

}  // namespace s4tp::hal::sim
