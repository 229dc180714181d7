#include "hal/linux/timer_tick.hpp"

namespace s4tp::hal::linux_host {

bool TimerTick::take() {
  const std::uint64_t now_us = clock_.now_us();
  if (now_us < due_us()) return false;
  const std::uint64_t late_us = now_us - due_us();
  const std::uint64_t skipped = late_us / kTickPeriodUs;
  wake_up_.late_us = late_us > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(late_us);
  wake_up_.skipped = skipped > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(skipped);
  due_us_ = due_us() + (skipped + 1U) * kTickPeriodUs;
  phase_us_ = 0;
  return true;
}

void TimerTick::adjust(std::int32_t phase_us) {
  phase_us_ = limited_phase_us(phase_us);
}

}  // namespace s4tp::hal::linux_host
