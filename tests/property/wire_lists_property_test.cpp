#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <random>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/support/bad_bus.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {
namespace {

Faults any_faults() {
  const auto chance = [] { return *rc::gen::element(0, 0, 3, 20, 80); };
  return {chance(), chance(), chance(), chance(), chance()};
}

// WIRE-020: lists of random length over a bus that loses, repeats, delays (up to 5 lists), damages and
// truncates: every list that comes out is one that was sent; and when the bus is good again, one arrives
// within 5 lists.
TEST(WireListsProperty, EveryTrackListIsOneThatWasSent) {
  EXPECT_TRUE(rc::check([](std::uint32_t seed) {
    constexpr int kLists = 60;
    constexpr int kListTime = 40;
    std::mt19937 random(seed);
    BadBus bus(seed, any_faults(), 5 * kListTime);
    TrackListSender sender;
    TrackListReceiver receiver;
    std::vector<Tracks> sent;
    const auto out_of_thin_air = [&](const Frame& frame) {
      return receiver.accept(frame) && std::find(sent.begin(), sent.end(), receiver.tracks()) == sent.end();
    };
    for (int list = 0; list < kLists; ++list) {
      sent.push_back(
          sample_tracks(static_cast<int>(random() % (kMaxTracks + 1)), static_cast<int>(random() % 5000)));
      std::vector<Frame> frames = frames_of(sender, sent.back());
      if (random() % 8 == 0) frames.resize(random() % (frames.size() + 1));  // half delivered
      for (std::size_t i = 0; i < frames.size(); ++i)
        bus.send(list * kListTime + static_cast<int>(i), frames[i]);
      for (const Frame& frame : bus.receive((list + 1) * kListTime)) RC_ASSERT(!out_of_thin_air(frame));
    }
    bool arrived = false;
    for (int list = 0; list < 5; ++list) {
      sent.push_back(sample_tracks(3, 9000 + list));
      for (const Frame& frame : frames_of(sender, sent.back())) {
        arrived = receiver.accept(frame) && receiver.tracks() == sent.back();
      }
    }
    RC_ASSERT(arrived);
  }));
}

/// What a good bus delivers of a map; lane_map_test shows that it is the map.
Map delivered(const Map& map) {
  MapSender sender;
  MapReceiver receiver;
  sender.update(map);
  for (std::uint32_t now_ms = 0; now_ms < 200; now_ms += 100) {
    for (const Frame& frame : frames_of(sender, now_ms, 2000)) static_cast<void>(receiver.accept(frame));
  }
  return receiver.map();
}

void change(Map& map, std::mt19937& random) {
  const auto below = [&](unsigned bound) { return static_cast<int>(random() % bound); };
  const int lane = below(8);
  const int conflict = below(6);
  switch (below(5)) {
    case 0:
      map.lanes[lane] = sample_lane(2 + below(11), below(5000));
      break;
    case 1:
      map.lanes[lane].present = false;
      break;
    case 2:
      map.conflicts[conflict] = sample_conflict(below(4), 4 + below(4), below(5000));
      break;
    case 3:
      map.conflicts[conflict].present = false;
      break;
    default:
      map.lanes[lane].left = static_cast<std::uint8_t>(below(8));
      break;
  }
}

// WIRE-030: a map that changes all the time over such a bus (delays up to 0.3 s): every map that comes out is
// one that was to be shown; and when the bus is good again, the last one arrives within the 5 s of the
// repetition.
TEST(WireListsProperty, EveryMapIsOneThatWasSent) {
  EXPECT_TRUE(rc::check([](std::uint32_t seed) {
    std::mt19937 random(seed);
    BadBus bus(seed, any_faults(), 300);
    const int pace = *rc::gen::inRange(1, 12);
    const unsigned changes = *rc::gen::inRange(0U, 4U);
    MapSender sender;
    MapReceiver receiver;
    Map map = sample_map(8, 4, 6);
    std::vector<Map> sent;
    for (int now_ms = 0; now_ms < 4000; now_ms += 10) {
      if (now_ms % 100 == 0) {
        for (unsigned i = 0; i < changes; ++i) change(map, random);
        sender.update(map);
        sent.push_back(delivered(map));
      }
      for (const Frame& frame : frames_of(sender, static_cast<std::uint32_t>(now_ms), pace))
        bus.send(now_ms, frame);
      for (const Frame& frame : bus.receive(now_ms)) {
        RC_ASSERT(!receiver.accept(frame) ||
                  std::find(sent.rbegin(), sent.rend(), receiver.map()) != sent.rend());
      }
    }
    for (std::uint32_t now_ms = 4000; now_ms < 10000; now_ms += 10) {
      for (const Frame& frame : frames_of(sender, now_ms, 10)) static_cast<void>(receiver.accept(frame));
    }
    RC_ASSERT(receiver.confirmed());
    RC_ASSERT(receiver.map() == sent.back());
  }));
}

bool within(float value, float limit) {
  return value >= -limit && value <= limit;
}

// WIRE-020, WIRE-030: frames of any content, some with a CRC that fits: nothing crashes, and what comes out
// is at least within its ranges and consistent.
TEST(WireListsProperty, NonsenseStaysWithinItsRanges) {
  EXPECT_TRUE(rc::check([](std::uint32_t seed) {
    std::mt19937 random(seed);
    TrackListReceiver tracks;
    MapReceiver map;
    for (int i = 0; i < 3000; ++i) {
      Frame frame;
      frame.id = random() % 16 == 0 ? static_cast<std::uint32_t>(random())
                                    : std::begin(kMessages)[random() % std::size(kMessages)].id;
      frame.length = random() % 8 == 0 ? static_cast<std::uint8_t>(random()) : 8;
      for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random());
      if (random() % 4 == 0) frame.data[2] = 0;  // lists that are short have a chance to be whole
      frame.data[1] &= random() % 2 == 0 ? 0x11 : 0xFF;
      if (random() % 4 != 0) e2e_seal(frame);
      if (tracks.accept(frame)) {
        RC_ASSERT(tracks.tracks().count <= kMaxTracks);
        for (int track = 0; track < tracks.tracks().count; ++track) {
          RC_ASSERT(within(tracks.tracks().items[track].x_m, 1311.0F));
          RC_ASSERT(within(tracks.tracks().items[track].heading_rad, 3.1416F));
        }
      }
      if (!map.accept(frame)) continue;
      LaneSet lanes = {};
      for (int slot = 0; slot < kMaxLanes; ++slot) {
        if (map.map().lanes[slot].present) lanes[slot / 32] |= 1U << (slot % 32);
      }
      for (const Lane& lane : map.map().lanes) RC_ASSERT(!lane.present || links_exist(lane, lanes));
      for (const Conflict& conflict : map.map().conflicts) {
        RC_ASSERT(!conflict.present || conflict_holds(conflict, lanes));
      }
    }
  }));
}

}  // namespace
}  // namespace s4tp::wire
