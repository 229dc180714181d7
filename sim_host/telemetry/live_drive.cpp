#include "sim_host/telemetry/live_drive.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

namespace s4tp::telemetry {
namespace {
constexpr std::chrono::milliseconds kTick{10};
}

void LiveDrive::begin(campaign::Trace* trace) {
  tap_.emplace(trace, trace);
  hal::linux_host::Reason reason;
  if (!tap_->open(name_, planner_, "within one process", parameters_, reason))
    throw std::runtime_error(std::string("--live: ") + reason.text);
}

void LiveDrive::ticked(const campaign::Driver& driver) {
  if (stop_ != nullptr && *stop_) throw DriveStopped();
  tap_->note_status(driver.core(), driver.bus());
  // What was late is not made up for: nobody could look at it.
  next_ = std::max(next_ + kTick, std::chrono::steady_clock::now());
  std::this_thread::sleep_until(next_);
}

}  // namespace s4tp::telemetry
