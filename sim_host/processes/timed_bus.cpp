#include "sim_host/processes/timed_bus.hpp"

#include <utility>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "hal/linux/host_clock.hpp"
#include "hal/linux/timer_tick.hpp"

namespace s4tp::processes {

int TimedBus::take(int timeout_ms) {
  int taken = 0;
  hal::CanFrame frame;
  bool more = can_.receive(frame);
  if (!more && timeout_ms > 0 && can_.wait(timeout_ms)) more = can_.receive(frame);
  while (more) {
    keep(frame);
    ++taken;
    more = taken < kQueueFrames && can_.receive(frame);  // a flood does not hold up the tick
  }
  return taken;
}

void TimedBus::keep(const hal::CanFrame& frame) {
  if (frame.length > 8) return;  // no FD frame is ours
  const bool is_tick = frame.id == wire::kTickId;
  if (is_tick && !opener_.opens(to_wire(frame), hal::linux_host::MonotonicClock().now_us() / 1000U)) {
    ++refused_ticks_;
    return;
  }
  heard_ = heard_ || is_tick;
  if (frame.id == wire::kMotionId && wire::e2e_crc_fits(to_wire(frame)))
    motion_us_ = hal::linux_host::monotonic_us(can_.received_at_us(), hal::kTickPeriodUs);
  if (size_ == kQueueFrames) {
    first_ = (first_ + 1) % kQueueFrames;
    --size_;
    ++dropped_;
  }
  queue_[(first_ + size_++) % kQueueFrames] = frame;
}

bool TimedBus::receive(hal::CanFrame& frame) {
  if (size_ == 0) return false;
  frame = queue_[first_];
  first_ = (first_ + 1) % kQueueFrames;
  --size_;
  return true;
}

hal::CanCounters TimedBus::counters() const {
  hal::CanCounters counters = can_.counters();
  counters.dropped += dropped_;
  return counters;
}

std::optional<std::uint64_t> TimedBus::take_motion_arrival() {
  return std::exchange(motion_us_, std::nullopt);
}

bool TimedBus::take_heard() {
  return std::exchange(heard_, false);
}

}  // namespace s4tp::processes
