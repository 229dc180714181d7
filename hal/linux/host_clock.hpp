#pragma once
/// The host's monotonic time, and sleeping on it until an instant.

#include <cstdint>

#include "hal/clock.hpp"

namespace s4tp::hal::linux_host {

/// A test has its own.
class HostClock : public Clock {
 public:
  /// Returns at `time_us` of now_us() or later. Until an instant and never for a while: what happens between
  /// asking and sleeping does not add up.
  virtual void sleep_until_us(std::uint64_t time_us) = 0;

 protected:
  ~HostClock() = default;
};

/// CLOCK_MONOTONIC: setting the time of day does not move it.
class MonotonicClock final : public HostClock {
 public:
  [[nodiscard]] std::uint64_t now_us() const override;
  void sleep_until_us(std::uint64_t time_us) override;
};

/// A time of day [us since 1970] on the monotonic clock; not later than now, and at most `age_max_us` ago,
/// so that setting the time of day does no more harm than that.
[[nodiscard]] std::uint64_t monotonic_us(std::uint64_t time_of_day_us, std::uint32_t age_max_us);

}  // namespace s4tp::hal::linux_host
