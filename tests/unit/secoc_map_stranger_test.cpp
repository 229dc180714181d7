// The map through the bus decorator of firmware/secoc with a stranger on the bus: forged records and heads, and
// authentic ones of another time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "firmware/secoc/map_records.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/support/secoc_can.hpp"

namespace s4tp::secoc {
namespace {

constexpr int kChangedLane = 7;

bool of_changed_lane(const wire::Frame& frame) {
  RecordPlace place;
  return find_place(frame, place) && place.record == kChangedLane;
}

struct SecocMapStranger : SecocMap {
  /// The map is whole and has been said again.
  void settle() {
    ASSERT_GE(until_whole(), 0);
    for (int i = 0; i < 40; ++i) (void)tick();
    ASSERT_TRUE(receiver.map() == map);
  }
  void change(int seed) {
    map.lanes[kChangedLane] = wire::sample_lane(5, seed);
    maps.update(map);
  }
  /// All that the world has said of maps since the last call, companions and all.
  Frames recorded() {
    Frames frames;
    for (const wire::Frame& frame : rig.wire.seen) {
      if (is_map(frame.id) || frame.id == wire::kMapAuthId) frames.push_back(frame);
    }
    rig.wire.seen.clear();
    return frames;
  }
  /// What the application gets when a stranger says these, one by one.
  Frames handed_on(const Frames& frames) {
    taken.clear();
    for (const wire::Frame& frame : frames) {
      rig.inject(frame);
      EXPECT_FALSE(take());
      (void)rig.world.take();
    }
    return taken;
  }
  /// Nothing but frames of records that stand as they are.
  void expect_nothing_older(const Frames& frames) {
    const wire::Map before = receiver.map();
    for (const wire::Frame& frame : handed_on(frames)) {
      EXPECT_GT(frame.id, wire::kMapSlotsId) << "a head";
      EXPECT_FALSE(of_changed_lane(frame));
    }
    EXPECT_TRUE(receiver.map() == before);
    EXPECT_TRUE(receiver.confirmed());
  }
  std::uint32_t refused() const { return rig.ecu.can->tally().refused; }
};

int companions(const Frames& frames) {
  return count(frames, wire::kMapAuthId);
}

/// Another point that adds the same to the map's digest.
wire::Frame point_of_same_check(const wire::Frame& point) {
  wire::Frame forged = point;
  for (std::uint32_t bits = 1; bits < 1U << 24U; ++bits) {
    for (unsigned i = 0; i < 3; ++i)
      forged.data[4 + i] = static_cast<std::uint8_t>(point.data[4 + i] ^ bits >> (8U * i));
    wire::e2e_seal(forged);
    if (wire::frame_check(forged) == wire::frame_check(point)) return forged;
  }
  ADD_FAILURE() << "no such point";
  return point;
}

// AUTH-020, AUTH-005 Forged records, whose contents would fit the digest or not: the application sees no frame
// of them, and the map that was there stays confirmed; the next change comes out at the latest when the
// record has come round (5 s).
TEST_F(SecocMapStranger, NoForgedRecord) {
  settle();
  const wire::Map before = receiver.map();
  Frames forged;
  const wire::Lane lane = wire::sample_lane(6, 777);
  for (std::uint8_t revision = 0; revision < 16; ++revision) {
    for (int part = 0; part < wire::part_count(lane); ++part) {
      wire::Frame frame;
      ASSERT_TRUE(wire::encode_part(lane, 4, revision, part, frame));
      forged.push_back(frame);
    }
  }
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 4; ++k) rig.inject(forged[static_cast<std::size_t>(4 * i + k) % forged.size()]);
    (void)tick();
    EXPECT_TRUE(receiver.confirmed()) << i;
    EXPECT_TRUE(receiver.map() == before) << i;
  }
  for (const wire::Frame& frame : taken) {
    EXPECT_TRUE(
        std::none_of(forged.begin(), forged.end(), [&](const wire::Frame& one) { return same(one, frame); }));
  }
  change(4242);
  EXPECT_GE(until_whole(520), 0);
  EXPECT_TRUE(receiver.map() == map);
}

// AUTH-020 Forged: a header and slots that leave a conflict out, with the digest that fits the others. Without
// the companion they do not come out.
TEST_F(SecocMapStranger, NoForgedHead) {
  settle();
  wire::Map smaller = map;
  smaller.conflicts[3] = wire::Conflict{};
  wire::MapSender forger;
  forger.update(map);
  (void)wire::frames_of(forger, 0, 100'000);
  forger.update(smaller);
  Frames head = wire::frames_of(forger, 100, 3);
  head.push_back(wire::Frame{wire::kMapAuthId, 8, {9, 9, 9, 9, 9, 9, 9, 9}});
  EXPECT_TRUE(handed_on(head).empty());
  for (int i = 0; i < 30; ++i) (void)tick();
  EXPECT_TRUE(receiver.map() == map);
  EXPECT_TRUE(receiver.confirmed());
}

// AUTH-020, AUTH-005 A genuine head whose digest forged records fit: in place of each point of a lane another
// one that adds the same to the digest. Who does not authenticate believes it; the ECU is shown nothing of that
// map until the genuine record has come round.
TEST_F(SecocMapStranger, NoForgedRecordUnderAGenuineHead) {
  wire::MapReceiver bare;
  rig.wire.lost = [&](const wire::Frame& frame) {
    const bool exchanged = frame.id == wire::kLanePointId && of_changed_lane(frame);
    const wire::Frame on_the_bus = exchanged ? point_of_same_check(frame) : frame;
    (void)bare.accept(on_the_bus);
    if (exchanged) rig.inject(on_the_bus);
    return exchanged;
  };
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(tick()) << i;
  EXPECT_TRUE(bare.confirmed());
  EXPECT_FALSE(bare.map().lanes[kChangedLane] == map.lanes[kChangedLane]);
  EXPECT_TRUE(taken.empty());
  EXPECT_GT(refused(), 0U);
  rig.wire.lost = nullptr;
  EXPECT_GE(until_whole(520), 0);
  EXPECT_TRUE(receiver.map() == map);
}

// AUTH-001, AUTH-020 The header before the first head that verifies is shown with it, and only as the map node
// says it: a stranger's, which says the same with another counter, is not.
TEST_F(SecocMapStranger, NoForgedHeaderBeforeTheFirst) {
  for (int i = 0; i < 600 && !receiver.confirmed(); ++i) {
    const Frames headers = rig.seen(wire::kMapHeaderId);
    if (!headers.empty()) {
      wire::Frame forged = headers.back();
      forged.data[1] =
          static_cast<std::uint8_t>((forged.data[1] & 0xF0U) | ((forged.data[1] & 0xFU) + 8U) % 15U);
      wire::e2e_seal(forged);
      rig.inject(forged);
    }
    (void)tick();
  }
  EXPECT_TRUE(receiver.confirmed());
  const Frames said = recorded();
  for (const wire::Frame& frame : taken) {
    EXPECT_TRUE(
        std::any_of(said.begin(), said.end(), [&](const wire::Frame& one) { return same(one, frame); }));
  }
}

// AUTH-004, AUTH-020 Replayed: the heads of an older map with their records and companions, all of them in
// their order, after a newer map: no head comes out, nor a record that has changed since. The next change
// comes out.
TEST_F(SecocMapStranger, NoReplayedHead) {
  settle();
  const Frames older = recorded();
  ASSERT_GE(companions(older), 4);
  change(4242);
  settle();
  const std::uint32_t before = refused();
  expect_nothing_older(older);
  EXPECT_EQ(refused(), before + static_cast<std::uint32_t>(companions(older)));
  for (int i = 0; i < 20; ++i) (void)tick();
  EXPECT_TRUE(receiver.map() == map);
  EXPECT_TRUE(receiver.confirmed());
  change(5000);
  EXPECT_GE(until_whole(520), 0);
  EXPECT_TRUE(receiver.map() == map);
}

// AUTH-004, AUTH-020 Reordered: a map that was held back, so that the ECU has never had it, does not come out
// once a newer one has. Before that it does.
TEST_F(SecocMapStranger, NoHeldBackMapAfterANewer) {
  settle();
  for (const bool too_late : {false, true}) {
    (void)recorded();
    rig.wire.lost = [](const wire::Frame& frame) { return is_map(frame.id) || frame.id == wire::kMapAuthId; };
    change(too_late ? 300 : 200);
    const wire::Map held_back = map;
    for (int i = 0; i < 15; ++i) EXPECT_FALSE(tick());
    const Frames older = recorded();
    ASSERT_GE(companions(older), 1);
    rig.wire.lost = nullptr;
    if (too_late) {
      change(4242);
      settle();
      expect_nothing_older(older);
    } else {
      for (const wire::Frame& frame : older) rig.inject(frame);
      EXPECT_TRUE(take());
    }
    EXPECT_EQ(receiver.map() == held_back, !too_late);
  }
}

// AUTH-010, AUTH-020 Heads of an earlier session, with all their records, whichever end has restarted since: none
// comes out, though the new session has had none and so their freshness values are above its last one.
TEST_F(SecocMapStranger, NoHeadOfAnEarlierSession) {
  for (int restarted = 1; restarted < 4; ++restarted) {
    settle();
    const Frames older = recorded();
    ASSERT_GE(companions(older), 4);
    const bool ecu = (restarted & 1) != 0;
    if (ecu) {
      rig.ecu.restart();
      receiver = {};
    }
    if ((restarted & 2) != 0) rig.world.restart();
    ASSERT_GE(rig.until_both_ways(), 0) << restarted;
    const Frames got = handed_on(older);
    EXPECT_EQ(std::count_if(got.begin(), got.end(),
                            [](const wire::Frame& frame) { return frame.id <= wire::kMapSlotsId; }),
              0);
    EXPECT_EQ(got.empty(), ecu) << "the records that stand come round in every session";
    receiver = {};
  }
  settle();
}

}  // namespace
}  // namespace s4tp::secoc
