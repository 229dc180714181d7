// The ends of a bus, and their names.

#include "sim_host/processes/bus_end.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "sim_host/processes/drive_on_bus.hpp"
#include "sim_host/processes/timed_bus.hpp"
#include "tests/support/fake_bus.hpp"
#include "tests/support/fake_kernel.hpp"
#include "tests/support/sealed_frames.hpp"

namespace s4tp::processes {
namespace {

using hal::linux_host::FakeBus;
using std::chrono::steady_clock;

// PROC-002 Realtime: a repeated TICK frame is refused and not handed on, all else is, in order; a motion
// frame's arrival is told once, a damaged one's not.
TEST(TimedBus, HandsOnWhatCounts) {
  FakeBus fake;
  TimedBus bus(fake);
  wire::E2eSender ticks;
  wire::E2eSender motions;
  const hal::CanFrame tick = tick_frame(1, ticks);
  hal::CanFrame damaged = sealed(wire::Motion{}, motions);
  damaged.data[0] ^= 0x55;
  for (const hal::CanFrame& frame : {damaged, tick, tick}) fake.incoming.push_back(frame);
  EXPECT_EQ(bus.take(0), 3);
  EXPECT_EQ(bus.refused_ticks(), 1U);
  EXPECT_TRUE(bus.take_heard());
  EXPECT_FALSE(bus.take_heard());
  EXPECT_FALSE(bus.take_motion_arrival());
  fake.incoming.push_back(sealed(wire::Motion{}, motions));
  EXPECT_EQ(bus.take(0), 1);
  EXPECT_TRUE(bus.take_motion_arrival());
  EXPECT_FALSE(bus.take_motion_arrival());
  std::vector<std::uint32_t> ids;
  for (hal::CanFrame frame; bus.receive(frame);) ids.push_back(frame.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{wire::kMotionId, wire::kTickId, wire::kMotionId}));
}

// The two sides' messages are all messages, each once.
TEST(BusEnd, SidesShareOutTheMessages) {
  const std::vector<std::uint32_t> ecu = ids_sent_by(Side::kEcu);
  const std::vector<std::uint32_t> world = ids_sent_by(Side::kWorld);
  EXPECT_EQ(ecu.size() + world.size(), std::size(wire::kMessages));
  EXPECT_NE(std::find(ecu.begin(), ecu.end(), wire::kCommandId), ecu.end());
  EXPECT_NE(std::find(world.begin(), world.end(), wire::kTickId), world.end());
}

// A listener's other end calls; a network interface has one name for both; a device has one end only.
TEST(BusEnd, OtherEnds) {
  EXPECT_EQ(other_end("slcan:listen:127.0.0.1:5000"), "slcan:tcp:127.0.0.1:5000");
  EXPECT_EQ(other_end("slcan:listen:anyone:5000"), "slcan:tcp:127.0.0.1:5000");
  EXPECT_EQ(other_end("vcan0"), "vcan0");
  EXPECT_TRUE(has_two_ends("vcan0"));
  EXPECT_TRUE(has_two_ends("slcan:listen:127.0.0.1:5000"));
  EXPECT_FALSE(has_two_ends("slcan:pty:/dev/pts/1"));
  EXPECT_FALSE(has_two_ends("slcan:tcp:127.0.0.1:5000"));
}

}  // namespace
}  // namespace s4tp::processes
