#include "hal/linux/host_clock.hpp"

#include <errno.h>
#include <time.h>

namespace s4tp::hal::linux_host {
namespace {

std::uint64_t read_us(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000U +
         static_cast<std::uint64_t>(now.tv_nsec) / 1000U;
}

}  // namespace

std::uint64_t MonotonicClock::now_us() const {
  return read_us(CLOCK_MONOTONIC);
}

void MonotonicClock::sleep_until_us(std::uint64_t time_us) {
  timespec until{};
  until.tv_sec = static_cast<time_t>(time_us / 1'000'000U);
  until.tv_nsec = static_cast<long>(time_us % 1'000'000U * 1000U);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

std::uint64_t monotonic_us(std::uint64_t time_of_day_us, std::uint32_t age_max_us) {
  const std::uint64_t today_us = read_us(CLOCK_REALTIME);
  std::uint64_t age_us = today_us > time_of_day_us ? today_us - time_of_day_us : 0;
  if (age_us > age_max_us) age_us = age_max_us;
  return read_us(CLOCK_MONOTONIC) - age_us;
}

}  // namespace s4tp::hal::linux_host
