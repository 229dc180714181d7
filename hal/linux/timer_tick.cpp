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
  phase_us_ = phase_us < -kMaxPhaseUs ? -kMaxPhaseUs : phase_us > kMaxPhaseUs ? kMaxPhaseUs : phase_us;
}

std::int32_t phase_shift_us(std::uint64_t arrival_us, std::uint32_t lead_us, std::uint64_t due_us) {
  constexpr auto kPeriod = static_cast<std::int32_t>(kTickPeriodUs);
  const auto wanted = static_cast<std::int32_t>((arrival_us + lead_us) % kTickPeriodUs);
  const auto is = static_cast<std::int32_t>(due_us % kTickPeriodUs);
  std::int32_t missing = wanted - is;
  if (missing > kPeriod / 2) missing -= kPeriod;
  if (missing < -kPeriod / 2) missing += kPeriod;
  return missing / 4;
}

}  // namespace s4tp::hal::linux_host
