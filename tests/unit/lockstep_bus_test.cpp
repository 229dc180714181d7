#include "firmware/lockstep/lockstep_bus.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/can/frames.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::lockstep {
namespace {

/// As a world sends it: it counts from 1, its counter from 0.
wire::Frame tick_frame(int number, int counter_lead = 0) {
  wire::Tick tick;
  tick.tick = static_cast<std::uint16_t>(number);
  wire::Frame frame;
  EXPECT_TRUE(wire::encode(tick, frame));
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) |
                                            static_cast<unsigned>((number - 1 + counter_lead) % 15));
  wire::e2e_seal(frame);
  return frame;
}

hal::CanFrame other_frame(std::uint32_t id) {
  hal::CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

std::vector<std::uint32_t> ids_of(LockstepBus& bus) {
  std::vector<std::uint32_t> ids;
  for (hal::CanFrame frame; bus.receive(frame);) ids.push_back(frame.id);
  return ids;
}

// PROC-001 Forward opens, by one or after losses; the same again, backwards and too far do not; nor does a
// damaged one. 16 bits wrap: 65536 is number 0.
TEST(TickOpener, OpensForwardOnly) {
  TickOpener opener;
  const std::uint64_t now = 0;
  EXPECT_FALSE(opener.opens(tick_frame(65534), now));
  EXPECT_TRUE(opener.opens(tick_frame(65535), now));
  EXPECT_FALSE(opener.opens(tick_frame(65535), now));
  EXPECT_TRUE(opener.opens(tick_frame(65536), now));
  EXPECT_FALSE(opener.opens(tick_frame(65535), now));
  EXPECT_TRUE(opener.opens(tick_frame(65556), now));
  EXPECT_FALSE(opener.opens(tick_frame(65577), now));
  wire::Frame damaged = tick_frame(65557);
  damaged.data[7] ^= 1;
  EXPECT_FALSE(opener.opens(damaged, now));
  EXPECT_TRUE(opener.opens(tick_frame(65557), now));
}

// PROC-001 An invented frame whose CRC fits and whose number is near: its counter tells on it, unless it is
// the one of 15 that fits.
TEST(TickOpener, NumberAndCounterGoTogether) {
  int opened = 0;
  for (int lead = 0; lead < 15; ++lead) {
    TickOpener opener;
    const std::uint64_t now = 0;
    EXPECT_TRUE(opener.opens(tick_frame(1), now));
    opened += opener.opens(tick_frame(4, lead), now) ? 1 : 0;
    EXPECT_TRUE(opener.opens(tick_frame(5), now)) << lead;
  }
  EXPECT_EQ(opened, 1);
}

// PROC-001 A world that starts again counts from 1; 1 s of silence tells it from a frame recorded earlier.
TEST(TickOpener, AnotherWorldAfterSilence) {
  TickOpener opener;
  const std::uint64_t start = 5000;
  EXPECT_TRUE(opener.opens(tick_frame(1), start));
  EXPECT_TRUE(opener.opens(tick_frame(2), start));
  EXPECT_FALSE(opener.opens(tick_frame(1), start + 999));
  EXPECT_TRUE(opener.opens(tick_frame(1), start + 1000));
}

// PROC-001 Before the world begins, and in a silence, one random frame with a CRC that fits opens nothing, so
// that the world's own next number does. An ECU that comes late needs two of them.
TEST(TickOpener, OneFrameIsNoWorld) {
  TickOpener opener;
  const std::uint64_t start = 5000;
  EXPECT_FALSE(opener.opens(tick_frame(40'000), start));
  EXPECT_TRUE(opener.opens(tick_frame(1), start));
  EXPECT_FALSE(opener.opens(tick_frame(40'000), start + 2000));
  EXPECT_TRUE(opener.opens(tick_frame(2), start + 2000));

  TickOpener late;
  EXPECT_FALSE(late.opens(tick_frame(700), start));
  EXPECT_TRUE(late.opens(tick_frame(701), start));
}

// PROC-002 Two ticks on the bus: the first holds its frames and none of the second.
TEST(LockstepBus, HandsOutTickByTick) {
  hal::linux_host::FakeBus fake;
  for (const int tick : {1, 2}) {
    fake.incoming.push_back(other_frame(0x100U + static_cast<std::uint32_t>(tick)));
    fake.incoming.push_back(to_hal(tick_frame(tick)));
  }
  fake.incoming.push_back(other_frame(0x103));
  LockstepBus bus(fake);
  ASSERT_TRUE(bus.take_tick(0));
  EXPECT_EQ(ids_of(bus), (std::vector<std::uint32_t>{0x101, wire::kTickId}));
  ASSERT_TRUE(bus.take_tick(0));
  EXPECT_EQ(ids_of(bus), (std::vector<std::uint32_t>{0x102, wire::kTickId}));
  EXPECT_FALSE(bus.take_tick(0));
  EXPECT_EQ(ids_of(bus), (std::vector<std::uint32_t>{0x103}));
}

// PROC-002 A TICK frame played again neither opens a tick nor reaches the ECU, whose counters it would
// disturb.
TEST(LockstepBus, RefusedTicksAreNotHandedOn) {
  hal::linux_host::FakeBus fake;
  LockstepBus bus(fake);
  fake.incoming = {to_hal(tick_frame(1)), to_hal(tick_frame(65'536)), to_hal(tick_frame(1))};
  EXPECT_TRUE(bus.take_tick(0));
  EXPECT_FALSE(bus.take_tick(0));
  EXPECT_EQ(ids_of(bus), (std::vector<std::uint32_t>{wire::kTickId}));
  EXPECT_EQ(bus.refused_ticks(), 2U);
}

// PROC-002 600 frames in one tick: the newest 255 of them and the TICK frame, which is what the ECU takes in
// a tick; 345 are counted.
TEST(LockstepBus, FloodKeepsTheNewest) {
  hal::linux_host::FakeBus fake;
  LockstepBus bus(fake);
  for (std::uint32_t i = 0; i < 600; ++i) fake.incoming.push_back(other_frame(0x100 + i));
  fake.incoming.push_back(to_hal(tick_frame(1)));
  EXPECT_FALSE(bus.take_tick(0));  // 256 a call
  EXPECT_FALSE(bus.take_tick(0));
  ASSERT_TRUE(bus.take_tick(0));
  const std::vector<std::uint32_t> ids = ids_of(bus);
  ASSERT_EQ(ids.size(), 256U);
  EXPECT_EQ(ids.front(), 0x100U + 345U);
  EXPECT_EQ(ids.back(), wire::kTickId);
  EXPECT_EQ(bus.counters().dropped, 345U);
}

// A flood without a TICK frame that never ends does not hold the caller up: the call comes back.
TEST(LockstepBus, EndlessFloodComesBack) {
  hal::linux_host::FakeBus fake;
  LockstepBus bus(fake);
  fake.incoming.push_back(other_frame(0x101));
  fake.endless = true;
  EXPECT_FALSE(bus.take_tick(0));
}

// State and sending go straight through.
TEST(LockstepBus, PassesTheBusThrough) {
  hal::linux_host::FakeBus fake;
  LockstepBus bus(fake);
  EXPECT_TRUE(bus.send(other_frame(8)));
  ASSERT_EQ(fake.sent.size(), 1U);
  fake.link = hal::CanState::kBusOff;
  EXPECT_EQ(bus.state(), hal::CanState::kBusOff);
  EXPECT_FALSE(bus.send(other_frame(8)));
}

}  // namespace
}  // namespace s4tp::lockstep
