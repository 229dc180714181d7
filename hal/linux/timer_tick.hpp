#pragma once
/// The 100 Hz tick of a program on Linux, phase-locked to the motion frame (hal/phase_lock.hpp).

#include <cstdint>

#include "hal/linux/host_clock.hpp"
#include "hal/phase_lock.hpp"
#include "hal/tick.hpp"

namespace s4tp::hal::linux_host {

/// How a tick was met.
struct WakeUp {
  std::uint32_t late_us = 0;
  std::uint32_t skipped = 0;  ///< ticks lost by it
};

class TimerTick final : public Tick {
 public:
  /// \param clock  must outlive this
  explicit TimerTick(HostClock& clock) : clock_(clock) {}

  void start(std::uint64_t first_us) { due_us_ = first_us; }
  /// When the next tick is due.
  [[nodiscard]] std::uint64_t due_us() const { return due_us_ + static_cast<std::uint64_t>(phase_us_); }
  /// Until the next tick is due.
  void sleep() { clock_.sleep_until_us(due_us()); }

  /// HAL-020 Due times are whole periods apart: neither a tick's work nor a late wake-up moves the following.
  /// HAL-021 Taken a whole period late or later: ticks whose time has passed are skipped and counted, never
  /// run in a burst.
  [[nodiscard]] bool take() override;
  /// HAL-022 Shifts the next tick, and all after it, by at most 500 us; the last call of a tick counts.
  void adjust(std::int32_t phase_us) override;
  /// Of the tick taken last.
  [[nodiscard]] const WakeUp& wake_up() const { return wake_up_; }

 private:
  HostClock& clock_;
  std::uint64_t due_us_ = 0;
  std::int32_t phase_us_ = 0;
  WakeUp wake_up_;
};

}  // namespace s4tp::hal::linux_host
