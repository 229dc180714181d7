// The map through the bus decorator of firmware/secoc, undisturbed: whole, in time, and with few CMACs.
#include <gtest/gtest.h>

#include "tests/support/secoc_can.hpp"

namespace s4tp::secoc {
namespace {

// AUTH-020 The largest map comes out whole and the same, within 1.5 s at a pace of 10 frames a tick, and is
// confirmed ten times a second from then on.
TEST_F(SecocMap, AWholeMapComesOut) {
  map = wire::sample_map(64, 12, 128);
  maps.update(map);
  const int ticks = until_whole();
  ASSERT_GE(ticks, 0);
  EXPECT_LE(ticks, 150);
  EXPECT_TRUE(receiver.map() == map);
  for (int i = 0; i < 600; ++i) {
    (void)tick();
    EXPECT_TRUE(receiver.confirmed()) << i;
  }
  EXPECT_EQ(rig.ecu.can->tally().refused, 0U);
}

// AUTH-020 A change is out in the tick in which its last frame is on the bus: as soon as a receiver without
// authentication has it whole.
TEST_F(SecocMap, AChangeIsNotLate) {
  wire::MapReceiver bare;  // sees the bus itself
  const auto both_ticks = [&](bool& bare_whole) {
    rig.wire.seen.clear();
    const bool whole = tick();
    bare_whole = false;
    for (const wire::Frame& frame : rig.wire.seen) bare_whole = bare.accept(frame) || bare_whole;
    return whole;
  };
  bool bare_whole = false;
  for (int i = 0; i < 100; ++i) (void)both_ticks(bare_whole);
  ASSERT_TRUE(receiver.confirmed());
  ASSERT_TRUE(bare.confirmed());
  int changes = 0;
  for (int seed = 1; seed < 12; ++seed) {
    for (int lane = 0; lane < seed; ++lane) map.lanes[lane] = wire::sample_lane(6, 100 * seed + lane);
    maps.update(map);
    for (int i = 0; i < 60; ++i) {
      const bool whole = both_ticks(bare_whole);
      EXPECT_EQ(whole, bare_whole) << seed << " tick " << i;
      changes += whole ? 1 : 0;
    }
    EXPECT_TRUE(receiver.map() == bare.map()) << seed;
  }
  EXPECT_EQ(changes, 11);
}

// AUTH-020 After either end has restarted the map is whole again: at once where the ECU's records stand, else
// as soon as they have come round.
TEST_F(SecocMap, ComesBackAfterARestart) {
  ASSERT_GE(until_whole(), 0);
  rig.ecu.restart();
  receiver = {};
  ASSERT_GE(until_whole(), 0);
  EXPECT_TRUE(receiver.map() == map);
}

// AUTH-020 Tags of records are made when a record changes and kept: a header costs two CMACs, whatever the
// size of the map.
TEST_F(SecocMap, TagsAreKept) {
  map = wire::sample_map(64, 12, 128);
  maps.update(map);
  ASSERT_GE(until_whole(), 0);
  for (int i = 0; i < 20; ++i) (void)tick();
  rig.ecu.keys.cmacs = 0;
  for (int i = 0; i < 10; ++i) (void)tick();
  // A command, a motion group a tick, one map header.
  EXPECT_LE(rig.ecu.keys.cmacs, 22);
}

}  // namespace
}  // namespace s4tp::secoc
