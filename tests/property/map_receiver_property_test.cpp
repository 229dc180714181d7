#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/support/plain_map_receiver.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {
namespace {

/// Sends any map and any part of it, in any order; a few slots and contents, so that they meet.
class AnySender {
 public:
  explicit AnySender(std::uint32_t seed) : random_(seed) {}

  bool happens(int chance_in_16) { return below(16) < chance_in_16; }

  /// What goes onto the bus next.
  std::vector<Frame> next(const PlainReceiver& receiver) {
    std::vector<Frame> frames;
    const int what = below(8);
    if (what < 3) {
      frames = happens(12) ? lane() : conflict();
      if (happens(6)) frames = {any_of(frames)};
    } else if (what < 5) {
      announce(receiver);
      frames = {header(), slots(0), slots(1)};
      if (happens(4)) std::shuffle(frames.begin(), frames.end(), random_);
    } else if (what < 7) {
      const int kind = below(3);
      frames = {kind == 0 ? header() : slots(kind - 1)};
    } else if (!sent_.empty()) {
      frames = {any_of(sent_)};
    }
    if (!frames.empty() && happens(1)) frames[0].data[1 + below(7)] ^= 4;
    for (const Frame& frame : frames) {
      if (frame.id != kMapHeaderId || happens(1)) sent_.push_back(frame);
    }
    return frames;
  }

 private:
  static constexpr std::array<int, 6> kLanes = {0, 1, 31, 32, 33, 63};
  static constexpr int kConflicts = 4;

  int below(int bound) { return static_cast<int>(random_() % static_cast<unsigned>(bound)); }
  template <typename Things>
  typename Things::value_type any_of(const Things& things) {
    return things[static_cast<std::size_t>(below(static_cast<int>(things.size())))];
  }

  template <typename Record>
  static std::vector<Frame> parts_of(const Record& record, int slot, int revision) {
    std::vector<Frame> frames(static_cast<std::size_t>(part_count(record)));
    for (int part = 0; part < part_count(record); ++part) {
      EXPECT_TRUE(encode_part(record, slot, static_cast<std::uint8_t>(revision), part,
                              frames[static_cast<std::size_t>(part)]));
    }
    return frames;
  }

  std::vector<Frame> lane() {
    Lane lane = sample_lane(happens(1) ? below(2) : 2 + below(3), below(3));
    if (happens(2)) lane.left = static_cast<std::uint8_t>(any_of(kLanes));
    return parts_of(lane, any_of(kLanes), below(3));
  }

  std::vector<Frame> conflict() {
    Conflict conflict = sample_conflict(any_of(kLanes), any_of(kLanes), below(3));
    conflict.present = conflict.first != conflict.second;
    return parts_of(conflict, below(kConflicts), below(3));
  }

  /// Another map, of records that are there for the most part; its digest is summed up anew.
  void announce(const PlainReceiver& receiver) {
    head_ = MapHeader{};
    head_.generation = static_cast<std::uint8_t>(below(2));
    head_.lanes_left_out = static_cast<std::uint8_t>(below(2));
    lanes_[0] = lanes_[1] = 0;
    for (const int slot : kLanes) {
      if (!happens(receiver.has(slot) ? 13 : 1)) continue;
      lanes_[slot / 32] |= 1U << (slot % 32);
      ++head_.lane_count;
    }
    int conflicts = 0;
    while (conflicts < kConflicts && receiver.has(kMaxLanes + conflicts) && happens(13)) ++conflicts;
    if (happens(1)) conflicts = kMaxConflicts;
    head_.conflict_count = static_cast<std::uint8_t>(conflicts);
    head_.digest = receiver.digest(lanes_, conflicts);
    if (happens(1)) ++head_.digest;
    for (int half = 0; half < 2; ++half) revisions_[half] = receiver.revisions(half, lanes_, conflicts);
    if (happens(1)) revisions_[below(2)] ^= 1;
  }

  Frame header() {
    Frame frame;
    EXPECT_TRUE(encode(head_, frame));
    protection_.protect(frame);
    return frame;
  }

  Frame slots(int half) {
    const MapSlots slots{head_.generation, static_cast<std::uint8_t>(half), lanes_[half], revisions_[half]};
    Frame frame;
    EXPECT_TRUE(encode(slots, frame));
    e2e_seal(frame);
    return frame;
  }

  std::mt19937 random_;
  E2eSender protection_;
  MapHeader head_;
  LaneSet lanes_ = {};
  std::uint16_t revisions_[2] = {};
  std::vector<Frame> sent_;
};

// WIRE-030, WIRE-035: headers, slots and records in any order, again, damaged, replaced and taken out of use: the
// receiver decides on each frame as one does that sums up anew, and what comes out is what the frames say.
TEST(MapReceiverProperty, DecidesAsOneThatSumsUpAnew) {
  int maps = 0;
  EXPECT_TRUE(rc::check([&maps](std::uint32_t seed) {
    AnySender sender(seed);
    PlainReceiver plain;
    MapReceiver receiver;
    for (int step = 0; step < 300; ++step) {
      for (const Frame& frame : sender.next(plain)) {
        const bool whole = plain.accept(frame);
        RC_ASSERT(receiver.accept(frame) == whole);
        RC_ASSERT(receiver.confirmed() == plain.confirmed());
        RC_ASSERT(receiver.rejected_frames() == plain.rejected());
        if (whole) RC_ASSERT(plain.is_in(receiver.map()));
        maps += whole ? 1 : 0;
      }
      if (!sender.happens(1)) continue;
      plain.nothing_arrived();
      receiver.nothing_arrived();
    }
  }));
  EXPECT_GT(maps, 1000);
}

}  // namespace
}  // namespace s4tp::wire
