#include "sim_host/faults/sender_faults.hpp"

#include <array>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::faults {
namespace {

using wire::Frame;

unsigned bit_of(const Frame& frame, unsigned bit) {
  return (frame.data[bit / 8] >> (bit % 8)) & 1U;
}

void set_bit(Frame& frame, unsigned bit, unsigned value) {
  const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
  frame.data[bit / 8] =
      static_cast<std::uint8_t>(value != 0U ? frame.data[bit / 8] | mask : frame.data[bit / 8] & ~mask);
}

void set_bits(Frame& frame, unsigned first, unsigned size, std::uint64_t value) {
  for (unsigned i = 0; i < size; ++i) set_bit(frame, first + i, static_cast<unsigned>(value >> i) & 1U);
}

void copy_bits(const Frame& from, Frame& to, unsigned first, unsigned size) {
  for (unsigned i = first; i < first + size; ++i) set_bit(to, i, bit_of(from, i));
}

/// Members of lists and records of the map carry a generation or revision instead of a counter, and say which
/// they are in the bits that follow.
bool is_member(std::uint32_t id) {
  return id == wire::kTrackPoseId || id == wire::kTrackMotionId ||
         (id >= wire::kLaneHeaderId && id <= wire::kConflictSecondId);
}

constexpr unsigned kFirstPayloadBit = 12;  // behind CRC and counter
constexpr unsigned kFirstMemberBit = 19;   // behind the longest index too
constexpr unsigned kBits = 64;
constexpr unsigned kTimeBits = 16;

unsigned first_free_bit(std::uint32_t id) {
  return is_member(id) ? kFirstMemberBit : kFirstPayloadBit;
}

/// Where the vehicle time stands; 0: nowhere.
unsigned time_bit(std::uint32_t id) {
  if (id == wire::kMotionId) return 12;
  return id == wire::kTrackListId ? 26U : 0U;
}

std::uint64_t pattern(int kind, unsigned size) {
  const std::uint64_t top = 1ULL << (size - 1U);
  switch (kind) {
    case 0:
      return 0;
    case 1:
      return ~0ULL;
    case 2:
      return top;
    case 3:
      return top - 1U;
    case 4:
      return 0x7FC00000'7FC00000ULL;
    case 5:
      return 0x7F800000'7F800000ULL;
    default:
      return 0x00000001'00000001ULL;
  }
}

void append_track(std::uint8_t generation, std::uint8_t index, std::uint64_t random,
                  std::vector<Frame>& frames) {
  for (const std::uint32_t id : {wire::kTrackPoseId, wire::kTrackMotionId}) {
    Frame frame;
    frame.id = id;
    frame.length = 8;
    random = traffic::next_seed(random);
    set_bits(frame, 0, kBits, random);
    if (id == wire::kTrackPoseId) {
      // Within 40 m of the origin, where the car starts: far ones would be nobody's concern.
      set_bits(frame, 16, 18, ((random >> 8U) % 8000U - 4000U) & 0x3FFFFU);
      set_bits(frame, 34, 18, ((random >> 28U) % 8000U - 4000U) & 0x3FFFFU);
    }
    set_bits(frame, 8, 4, generation);
    set_bits(frame, 12, 4, index);
    wire::e2e_seal(frame);
    frames.push_back(frame);
  }
}

}  // namespace

std::uint64_t draw(const Fault& fault, int tick, std::size_t place) {
  const auto where = static_cast<std::uint64_t>(tick + kPreRollTicks) * 4096U + place;
  return traffic::next_seed(traffic::next_seed(fault.dice) ^ where);
}

void shift_clock(const Fault& fault, int tick, Frame& frame) {
  const unsigned first = time_bit(frame.id);
  if (first == 0U) return;
  const int since = tick - fault.from_tick + 1;
  int shift_ms = fault.intensity;
  if (fault.kind == FaultKind::kEarlyMotion) shift_ms = -fault.intensity * since;
  if (fault.kind == FaultKind::kLateMotion) shift_ms = fault.intensity * since;
  std::uint32_t stamp = 0;
  for (unsigned i = 0; i < kTimeBits; ++i) stamp |= bit_of(frame, first + i) << i;
  set_bits(frame, first, kTimeBits, stamp + static_cast<std::uint32_t>(shift_ms));
  wire::e2e_seal(frame);
}

void hold(const Fault& fault, std::map<std::uint32_t, Frame>& held, Frame& frame) {
  const bool track = frame.id == wire::kTrackPoseId || frame.id == wire::kTrackMotionId;
  const std::uint32_t key = frame.id * 16U + (track ? frame.data[1] >> 4U : 0U);
  const Frame& old = held.emplace(key, frame).first->second;
  const Frame now = frame;
  frame = old;
  copy_bits(now, frame, 8, 4);
  if (fault.intensity == 0 && frame.id == wire::kMotionId)
    copy_bits(now, frame, time_bit(frame.id), kTimeBits);
  wire::e2e_seal(frame);
}

void overwrite(const Fault& fault, Frame& frame) {
  const std::uint64_t random = draw(fault, 0, frame.id);
  unsigned first = first_free_bit(frame.id);
  unsigned size = kBits - first;
  if (random % 2U == 0U) {  // some of it only: most fields are 4 to 21 bits wide
    first += static_cast<unsigned>((random >> 8U) % (kBits - 4U - first));
    size = 4U + static_cast<unsigned>((random >> 16U) % 18U);
    if (first + size > kBits) size = kBits - first;
  }
  set_bits(frame, first, size, pattern(fault.intensity, size));
  wire::e2e_seal(frame);
}

void lengthen(const Fault& fault, int tick, std::vector<Frame>& frames) {
  std::vector<Frame> result;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame frame = frames[i];
    const std::uint64_t random = draw(fault, tick, i);
    bool changed = true;
    if (fault.intensity == 0 && frame.id == wire::kTrackListId) {
      set_bits(frame, 16, 5, 17U + random % 15U);
    } else if (fault.intensity == 1 && frame.id == wire::kTrackListId) {
      set_bits(frame, 16, 5, 16U);
    } else if (fault.intensity == 3 && frame.id == wire::kMapHeaderId) {
      set_bits(frame, 20, 7, 65U + random % 63U);
      set_bits(frame, 27, 8, 129U + (random >> 16U) % 127U);
    } else if (fault.intensity == 4 && frame.id == wire::kLaneHeaderId) {
      set_bits(frame, 22, 4, 13U + random % 3U);
    } else {
      changed = false;
    }
    if (changed) wire::e2e_seal(frame);
    const bool list = frame.id == wire::kTrackListId;
    if (fault.intensity == 1 && (frame.id == wire::kTrackPoseId || frame.id == wire::kTrackMotionId))
      continue;
    result.push_back(frame);
    if (!list || (fault.intensity != 1 && fault.intensity != 2)) continue;
    const auto generation = static_cast<std::uint8_t>((frame.data[1] >> 4U) & 0xFU);
    const auto count = static_cast<std::uint8_t>(fault.intensity == 1 ? 0U : frame.data[2] & 0x1FU);
    for (std::uint8_t index = count; index < 16; ++index) {
      append_track(generation, index, traffic::next_seed(random + index), result);
    }
  }
  frames = result;
}

void babble(const Fault& fault, int tick, std::vector<Frame>& frames) {
  for (int i = 0; i < fault.intensity; ++i) {
    const std::uint64_t random = draw(fault, tick, 1000U + static_cast<std::size_t>(i));
    Frame frame;
    frame.id = message(static_cast<int>(random % kMessageCount)).id;
    if (!contains(fault.messages, frame.id)) continue;
    frame.length = 8;
    set_bits(frame, 0, kBits, traffic::next_seed(random));
    wire::e2e_seal(frame);
    frames.insert(frames.begin() + static_cast<std::ptrdiff_t>((random >> 32U) % (frames.size() + 1U)),
                  frame);
  }
}

}  // namespace s4tp::faults
