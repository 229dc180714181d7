#include "firmware/ecu/lockstep_bus.hpp"

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::ecu {
namespace {

constexpr std::uint64_t kOtherWorldAfterMs = 1000;

}  // namespace

bool TickOpener::opens(const wire::Frame& frame, std::uint64_t now_ms) {
  wire::Tick tick;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, tick)) return false;
  const auto ahead = static_cast<std::uint16_t>(tick.tick - number_);
  const bool follows = ahead >= 1 && ahead <= kAheadMax;
  if (seen_ && !follows && now_ms < opened_ms_ + kOtherWorldAfterMs) return false;
  seen_ = true;
  number_ = tick.tick;
  opened_ms_ = now_ms;
  return true;
}

bool LockstepBus::take_tick(std::uint64_t now_ms) {
  hal::CanFrame frame;
  for (int i = 0; i < kQueueFrames && can_.receive(frame); ++i) {
    if (take(frame, now_ms)) return true;
  }
  return false;
}

bool LockstepBus::take(const hal::CanFrame& can_frame, std::uint64_t now_ms) {
  if (can_frame.length > 8) return false;  // no FD frame is ours
  wire::Frame frame;
  frame.id = can_frame.id;
  frame.length = can_frame.length;
  for (int i = 0; i < frame.length; ++i) frame.data[i] = can_frame.data[i];
  const bool is_tick = frame.id == wire::kTickId;
  if (is_tick && !opener_.opens(frame, now_ms)) {
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
  const wire::Frame& oldest = queue_[first_];
  frame = {};
  frame.id = oldest.id;
  frame.length = oldest.length;
  for (int i = 0; i < oldest.length; ++i) frame.data[i] = oldest.data[i];
  first_ = (first_ + 1) % kQueueFrames;
  --size_;
  return true;
}

hal::CanCounters LockstepBus::counters() const {
  hal::CanCounters counters = can_.counters();
  counters.dropped += dropped_;
  return counters;
}

}  // namespace s4tp::ecu
