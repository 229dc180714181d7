#include "firmware/lockstep/lockstep_bus.hpp"

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"

namespace s4tp::lockstep {
namespace {

constexpr std::uint64_t kOtherWorldAfterMs = 1000;
constexpr int kCounters = 15;  // of end-to-end protection

}  // namespace

bool TickOpener::follows(const Place& last, const Place& next) {
  const int ahead = static_cast<std::uint16_t>(next.number - last.number);
  const int counted = (next.counter + kCounters - last.counter) % kCounters;
  return last.known && ahead >= 1 && ahead <= kAheadMax && counted == ahead % kCounters;
}

bool TickOpener::opens(const wire::Frame& frame, std::uint64_t now_ms) {
  wire::Tick tick;
  if (!wire::e2e_crc_fits(frame) || !wire::decode(frame, tick)) return false;
  const Place place{tick.tick, static_cast<std::uint8_t>(frame.data[1] & 0x0FU), true};
  if (!follows(last_, place)) {
    if (last_.known && now_ms < opened_ms_ + kOtherWorldAfterMs) return false;
    const bool second = follows(candidate_, place);
    candidate_ = place;
    if (place.number != 1 && !second) return false;
  }
  last_ = place;
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
  const wire::Frame frame = to_wire(can_frame);
  const bool is_tick = frame.id == wire::kTickId;
  if (is_tick && !opener_.opens(frame, now_ms)) {
    ++refused_ticks_;
    return false;
  }
  if (size_ == kQueueFrames) {
    first_ = (first_ + 1) % kQueueFrames;
    --size_;
    ++dropped_;
  }
  queue_[(first_ + size_++) % kQueueFrames] = frame;
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

}  // namespace s4tp::lockstep
