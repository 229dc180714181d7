#include "firmware/ecu/vehicle_clock.hpp"

#include <gtest/gtest.h>

namespace s4tp::ecu {
namespace {

// The 16-bit stamp wraps from 65530 to 4: 10 ms later, at 65540.
TEST(VehicleClock, ExtendsOverTheWrap) {
  VehicleClock clock;
  EXPECT_FALSE(clock.started());
  EXPECT_EQ(clock.update(65530), 10);
  EXPECT_EQ(clock.now_ms(), 65530U);
  EXPECT_EQ(clock.update(4), 10);
  EXPECT_EQ(clock.now_ms(), 65540U);
}

// ECU-071: 3 ticks without a stamp are 30 ms; a stamp 40 ms after the last is then 10 ms on.
TEST(VehicleClock, CoastsAndJoinsAgain) {
  VehicleClock clock;
  clock.coast();
  EXPECT_EQ(clock.now_ms(), 0U);
  (void)clock.update(100);
  for (int i = 0; i < 3; ++i) clock.coast();
  EXPECT_EQ(clock.now_ms(), 130U);
  EXPECT_EQ(clock.update(140), 40);
  EXPECT_EQ(clock.now_ms(), 140U);
}

// ECU-071: the world paused for 500 ticks: its next stamp, 10 ms on, moves nothing back; the one after
// adds 10.
TEST(VehicleClock, StaysWhereItCoastedTo) {
  VehicleClock clock;
  (void)clock.update(100);
  for (int i = 0; i < 500; ++i) clock.coast();
  (void)clock.update(110);
  EXPECT_EQ(clock.now_ms(), 5100U);
  (void)clock.update(120);
  EXPECT_EQ(clock.now_ms(), 5110U);
}

// ECU-070: a stamp that goes back, or stands still, lets 10 ms pass; the next interval counts from it.
TEST(VehicleClock, NeverRunsBack) {
  VehicleClock clock;
  (void)clock.update(1000);
  EXPECT_EQ(clock.update(400), -600);
  EXPECT_EQ(clock.now_ms(), 1010U);
  EXPECT_EQ(clock.update(400), 0);
  EXPECT_EQ(clock.now_ms(), 1020U);
  EXPECT_EQ(clock.update(410), 10);
  EXPECT_EQ(clock.now_ms(), 1030U);
}

// ECU-072: a stamp 100 ms old keeps its distance across the wrap, be it that of 16 bits or that of 32: 586 ms
// before a start at 50 is 2^32 - 536.
TEST(VehicleClock, ExtendsOtherStamps) {
  VehicleClock clock;
  (void)clock.update(65500);
  (void)clock.update(20);
  EXPECT_EQ(clock.now_ms(), 65556U);
  EXPECT_EQ(clock.extend(65456), 65456U);
  EXPECT_EQ(clock.extend(30), 65566U);
  VehicleClock young;
  (void)young.update(50);
  EXPECT_EQ(young.extend(65000), 0xFFFFFFFFU - 535U);
  EXPECT_EQ(elapsed_ms(young.extend(65000), young.now_ms()), 586);
}

// ECU-072: stamps 32767 ms apart reach the end of 32 bits; from there on 10 ms are 10 ms as before, with a
// stamp or without one.
TEST(VehicleClock, WrapsWithoutNotice) {
  VehicleClock clock;
  std::uint16_t stamp_ms = 0;
  (void)clock.update(stamp_ms);
  while (clock.now_ms() < 0xFFFF0000U)
    (void)clock.update(stamp_ms = static_cast<std::uint16_t>(stamp_ms + 32767U));
  std::uint32_t now_ms = clock.now_ms();
  for (int i = 0; i < 20'000; ++i) {
    stamp_ms = static_cast<std::uint16_t>(stamp_ms + 10U);
    if (i % 7 == 3) {
      clock.coast();
    } else {
      ASSERT_EQ(clock.update(stamp_ms), i % 7 == 4 ? 20 : 10);
    }
    ASSERT_EQ(clock.now_ms(), now_ms += 10U) << i;
  }
  EXPECT_LT(now_ms, 0x10000U * 4U);
}

// ECU-072: an age is counted: it is not young again after 2^32 ms, and what was never seen never was.
TEST(VehicleClock, AgesDoNotWrap) {
  Age age;
  age.pass(1000);
  EXPECT_FALSE(age.known());
  age.renew();
  for (int i = 0; i < 5; ++i) age.pass(0x40000000U);
  EXPECT_TRUE(age.known());
  EXPECT_EQ(age.ms(), kNeverMs - 1U);
  age.renew();
  age.pass(10);
  EXPECT_EQ(age.ms(), 10U);
}

}  // namespace
}  // namespace s4tp::ecu
