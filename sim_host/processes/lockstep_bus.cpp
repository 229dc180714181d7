#include "sim_host/processes/lockstep_bus.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/campaign/frames.hpp"

namespace s4tp::processes {
namespace {

using std::chrono::steady_clock;
constexpr std::chrono::seconds kOtherWorldAfter{1};

}  // namespace

bool TickOpener::opens(const wire::Frame& frame, Time now) {
  wire::Tick tick;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, tick)) return false;
  const auto ahead = static_cast<std::uint16_t>(tick.tick - number_);
  const bool follows = ahead >= 1 && ahead <= kAheadMax;
  if (seen_ && !follows && now < opened_ + kOtherWorldAfter) return false;
  seen_ = true;
  number_ = tick.tick;
  opened_ = now;
  return true;
}

bool LockstepBus::wait_tick(int timeout_ms) {
  const auto end = steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  for (;;) {
    const auto now = steady_clock::now();
    hal::CanFrame frame;
    if (can_.receive(frame)) {
      if (take(frame, now)) return true;
    } else if (now < end) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
      (void)can_.wait(static_cast<int>(left.count()));
    }
    if (now >= end) return false;
  }
}

bool LockstepBus::take(const hal::CanFrame& frame, TickOpener::Time now) {
  if (frame.length > 8) return false;  // no FD frame is ours
  const bool is_tick = frame.id == wire::kTickId;
  if (is_tick && !opener_.opens(campaign::to_wire(frame), now)) {
    ++refused_ticks_;
    return false;
  }
  if (size_ < kQueueFrames) {
    queue_[(first_ + size_++) % kQueueFrames] = frame;
  } else {
    ++dropped_;
    if (is_tick) queue_[(first_ + size_ - 1) % kQueueFrames] = frame;
  }
  return is_tick;
}

bool LockstepBus::receive(hal::CanFrame& frame) {
  if (size_ == 0) return false;
  frame = queue_[first_];
  first_ = (first_ + 1) % kQueueFrames;
  --size_;
  return true;
}

hal::CanCounters LockstepBus::counters() const {
  hal::CanCounters counters = can_.counters();
  counters.dropped += dropped_;
  return counters;
}

}  // namespace s4tp::processes
