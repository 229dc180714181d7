#include "firmware/ecu/vehicle_clock.hpp"

namespace s4tp::ecu {
namespace {

/// later - earlier on the 16-bit circle, in -32768 .. 32767.
std::int32_t difference(std::uint16_t later, std::uint16_t earlier) {
  const auto turned = static_cast<std::uint16_t>(later - earlier);
  return turned < 0x8000U ? static_cast<std::int32_t>(turned) : static_cast<std::int32_t>(turned) - 0x10000;
}

}  // namespace

std::int32_t VehicleClock::update(std::uint16_t stamp_ms) {
  if (!started_) {
    started_ = true;
    last_stamp_ms_ = stamp_ms;
    last_ms_ = stamp_ms;
    now_ms_ = stamp_ms;
    return static_cast<std::int32_t>(kTickMs);
  }
  const std::int32_t interval_ms = difference(stamp_ms, last_stamp_ms_);
  if (interval_ms > 0) {
    const std::uint32_t stamped_ms = last_ms_ + static_cast<std::uint32_t>(interval_ms);
    if (elapsed_ms(now_ms_, stamped_ms) > 0) now_ms_ = stamped_ms;
  } else {
    coast();
  }
  last_stamp_ms_ = stamp_ms;
  last_ms_ = now_ms_;
  return interval_ms;
}

void VehicleClock::coast() {
  if (started_) now_ms_ += kTickMs;
}

std::uint32_t VehicleClock::extend(std::uint16_t stamp_ms) const {
  return last_ms_ + static_cast<std::uint32_t>(difference(stamp_ms, last_stamp_ms_));
}

}  // namespace s4tp::ecu
