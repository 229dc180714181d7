#include "firmware/ecu/lockstep_bus.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/campaign/frames.hpp"
#include "tests/support/fake_bus.hpp"

namespace s4tp::ecu {
namespace {

wire::Frame tick_frame(int number) {
  wire::Tick tick;
  tick.tick = static_cast<std::uint16_t>(number);
  wire::Frame frame;
  EXPECT_TRUE(wire::encode(tick, frame));
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
// damaged one.
TEST(TickOpener, OpensForwardOnly) {
  TickOpener opener;
  const std::uint64_t now = 0;
  EXPECT_TRUE(opener.opens(tick_frame(65535), now));
  EXPECT_FALSE(opener.opens(tick_frame(65535), now));
  EXPECT_TRUE(opener.opens(tick_frame(0), now));  // 16 bits wrap
  EXPECT_FALSE(opener.opens(tick_frame(65535), now));
  EXPECT_TRUE(opener.opens(tick_frame(1000), now));
  EXPECT_FALSE(opener.opens(tick_frame(2001), now));
  wire::Frame damaged = tick_frame(1001);
  damaged.data[7] ^= 1;
  EXPECT_FALSE(opener.opens(damaged, now));
  EXPECT_TRUE(opener.opens(tick_frame(1001), now));
}

// PROC-001 A world that starts again counts from 1; 1 s of silence tells it from a frame recorded earlier.
TEST(TickOpener, AnotherWorldAfterSilence) {
  TickOpener opener;
  const std::uint64_t start = 5000;
  EXPECT_TRUE(opener.opens(tick_frame(500), start));
  EXPECT_FALSE(opener.opens(tick_frame(1), start + 999));
  EXPECT_TRUE(opener.opens(tick_frame(1), start + 1000));
}

// PROC-002 Two ticks on the bus: the first holds its frames and none of the second.
TEST(LockstepBus, HandsOutTickByTick) {
  hal::linux_host::FakeBus fake;
  for (const int tick : {1, 2}) {
    fake.incoming.push_back(other_frame(0x100U + static_cast<std::uint32_t>(tick)));
    fake.incoming.push_back(campaign::to_hal(tick_frame(tick)));
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
  fake.incoming = {campaign::to_hal(tick_frame(7)), campaign::to_hal(tick_frame(6)),
                   campaign::to_hal(tick_frame(7))};
  EXPECT_TRUE(bus.take_tick(0));
  EXPECT_FALSE(bus.take_tick(0));
  EXPECT_EQ(ids_of(bus), (std::vector<std::uint32_t>{wire::kTickId}));
  EXPECT_EQ(bus.refused_ticks(), 2U);
}

// PROC-002 600 frames in one tick: 511 of them, then the TICK frame; 89 and the one it took the place of are
// counted.
TEST(LockstepBus, FloodKeepsTheTick) {
  hal::linux_host::FakeBus fake;
  LockstepBus bus(fake);
  for (int i = 0; i < 600; ++i) fake.incoming.push_back(other_frame(0x101));
  fake.incoming.push_back(campaign::to_hal(tick_frame(1)));
  EXPECT_FALSE(bus.take_tick(0));  // 512 a call
  ASSERT_TRUE(bus.take_tick(0));
  const std::vector<std::uint32_t> ids = ids_of(bus);
  EXPECT_EQ(ids.size(), 512U);
  EXPECT_EQ(ids.back(), wire::kTickId);
  EXPECT_EQ(bus.counters().dropped, 89U);
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
}  // namespace s4tp::ecu
