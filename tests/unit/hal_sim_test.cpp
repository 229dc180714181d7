#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "hal/sim/bus.hpp"
#include "hal/sim/lockstep_tick.hpp"
#include "hal/sim/memory_flash_bank.hpp"
#include "hal/sim/null_devices.hpp"

namespace s4tp::hal::sim {
namespace {

CanFrame numbered(std::uint32_t id) {
  CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

struct Loss final : BusFault {
  bool pass(CanFrame& frame) override {
    frame.data[0] ^= 1U;
    return frame.id != 7;
  }
};

// HAL-001: of ports a, b, c, what a sends reaches b and c in order and never a itself.
TEST(SimBus, EveryOtherPortReceivesInOrder) {
  auto bus = std::make_unique<Bus>();
  Bus::Port* a = bus->attach();
  Bus::Port* b = bus->attach();
  Bus::Port* c = bus->attach();
  ASSERT_TRUE(a->send(numbered(1)));
  ASSERT_TRUE(a->send(numbered(2)));
  CanFrame frame;
  EXPECT_FALSE(a->receive(frame));
  for (Bus::Port* port : {b, c}) {
    ASSERT_TRUE(port->receive(frame));
    EXPECT_EQ(frame.id, 1U);
    ASSERT_TRUE(port->receive(frame));
    EXPECT_EQ(frame.id, 2U);
    EXPECT_FALSE(port->receive(frame));
  }
}

// HAL-002: 512 frames fit; the 513th is lost and counted, and the 512 are still there.
TEST(SimBus, FullQueueDropsAndCounts) {
  auto bus = std::make_unique<Bus>();
  Bus::Port* a = bus->attach();
  Bus::Port* b = bus->attach();
  for (int i = 0; i < Bus::kQueueFrames + 1; ++i)
    ASSERT_TRUE(a->send(numbered(static_cast<std::uint32_t>(i))));
  EXPECT_EQ(b->counters().dropped, 1U);
  EXPECT_EQ(b->counters().received, 512U);
  CanFrame frame;
  for (int i = 0; i < Bus::kQueueFrames; ++i) {
    ASSERT_TRUE(b->receive(frame));
    ASSERT_EQ(frame.id, static_cast<std::uint32_t>(i));
  }
  EXPECT_FALSE(b->receive(frame));
}

// HAL-002: a port that is bus-off neither sends nor hears, and recovers.
TEST(SimBus, BusOffSendsNothing) {
  auto bus = std::make_unique<Bus>();
  Bus::Port* a = bus->attach();
  Bus::Port* b = bus->attach();
  b->set_state(CanState::kBusOff);
  EXPECT_FALSE(b->send(numbered(1)));
  EXPECT_EQ(b->counters().dropped, 1U);
  ASSERT_TRUE(a->send(numbered(2)));
  b->set_state(CanState::kActive);
  CanFrame frame;
  EXPECT_FALSE(b->receive(frame));
  ASSERT_TRUE(a->send(numbered(3)));
  ASSERT_TRUE(b->receive(frame));
  EXPECT_EQ(frame.id, 3U);
}

// The fault hook changes what passes and loses what it refuses.
TEST(SimBus, FaultHookDropsAndCorrupts) {
  auto bus = std::make_unique<Bus>();
  Loss loss;
  bus->fault = &loss;
  Bus::Port* a = bus->attach();
  Bus::Port* b = bus->attach();
  ASSERT_TRUE(a->send(numbered(7)));
  ASSERT_TRUE(a->send(numbered(8)));
  CanFrame frame;
  ASSERT_TRUE(b->receive(frame));
  EXPECT_EQ(frame.id, 8U);
  EXPECT_EQ(frame.data[0], 1U);
}

// A fifth port is refused.
TEST(SimBus, RefusesMorePortsThanItHas) {
  auto bus = std::make_unique<Bus>();
  for (int i = 0; i < Bus::kMaxPorts; ++i) EXPECT_NE(bus->attach(), nullptr);
  EXPECT_EQ(bus->attach(), nullptr);
}

// HAL-010: two TICK frames (id 0x13) among others open exactly two ticks.
TEST(LockstepTick, OpensOnTickFrames) {
  auto bus = std::make_unique<Bus>();
  Bus::Port* world = bus->attach();
  Bus::Port* ecu = bus->attach();
  LockstepTick tick(0x13);
  ecu->listener = &tick;
  EXPECT_FALSE(tick.take());
  for (const std::uint32_t id : {0x10U, 0x13U, 0x11U, 0x13U}) ASSERT_TRUE(world->send(numbered(id)));
  tick.adjust(500);
  EXPECT_TRUE(tick.take());
  EXPECT_TRUE(tick.take());
  EXPECT_FALSE(tick.take());
}

// HAL-012, HAL-013: three kicks count three; the cycle counter never moves.
TEST(NullDevices, CountKicksAndNoCycles) {
  NullWatchdog watchdog;
  for (int i = 0; i < 3; ++i) watchdog.kick();
  EXPECT_EQ(watchdog.kicks(), 3U);
  EXPECT_EQ(NullCycleCounter().now(), 0U);
}

// HAL-030, HAL-031: what is written is read back; bits come back to 1 by erasing only; nothing beyond the
// end.
TEST(MemoryFlashBank, BehavesLikeFlash) {
  auto bank = std::make_unique<MemoryFlashBank>();
  const std::uint8_t data[2] = {0x0F, 0xF0};
  std::uint8_t back[2] = {};
  ASSERT_TRUE(bank->write(10, data, 2));
  ASSERT_TRUE(bank->read(10, back, 2));
  EXPECT_EQ(std::memcmp(data, back, 2), 0);
  EXPECT_EQ(std::memcmp(data, static_cast<const std::uint8_t*>(bank->mapped()) + 10, 2), 0);
  const std::uint8_t more_bits[2] = {0x1F, 0xF0};
  EXPECT_FALSE(bank->write(10, more_bits, 2));
  ASSERT_TRUE(bank->erase());
  EXPECT_TRUE(bank->write(10, more_bits, 2));
  EXPECT_FALSE(bank->write(bank->size() - 1, data, 2));
  EXPECT_FALSE(bank->read(bank->size() - 1, back, 2));
  EXPECT_FALSE(bank->read(0xFFFFFFFFU, back, 2));
}

}  // namespace
}  // namespace s4tp::hal::sim
