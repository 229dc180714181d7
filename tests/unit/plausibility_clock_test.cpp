/// A vehicle clock that is off, and what the plausibility monitor sees of it.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/plausibility_drive.hpp"

namespace s4tp::ecu {
namespace {

// PLAUS-011: stamps 11 ms apart at ticks of 10 ms are seen within 1.5 s; one tick that comes 100 ms late is
// the platform's.
TEST(PlausibilityClock, AgainstTicks) {
  const auto fast = [](float, Measured& told) { told.passed_ms = 11; };
  const int ticks = ticks_until(Check::kClock, fast);
  EXPECT_GT(ticks, 100);
  EXPECT_LE(ticks, 150);
  const auto once = [](float since_s, Measured& told) { told.passed_ms = since_s < 0.015F ? 100 : 10; };
  EXPECT_EQ(ticks_until(Check::kClock, once), -1);
}

/// Stamps in whole milliseconds of a clock that runs faster by this share.
Drive::Lie clock_faster_by(double share) {
  return [share](float since_s, Measured& told) {
    const double tick = std::round(100.0 * static_cast<double>(since_s));
    const auto stamp_ms = [share](double ticks) { return std::floor(10.0 * (1.0 + share) * ticks); };
    told.passed_ms = static_cast<std::uint32_t>(stamp_ms(tick) - stamp_ms(tick - 1.0));
  };
}

// PLAUS-011: a clock that runs faster by r adds 10 r ms a tick to a sum that forgets 5 (1 + r) thousandths of itself a tick:
// 2000 r / (1 + r) ms in the end, of 100. So 5 % fast (95 ms) and 4 % slow (83 ms) are never seen, 5 % slow (105 ms) and
// 6 % fast (113 ms) are, once 1 - exp(-t / 2 s) has come so far: after 6.3 and 4.1 s.
TEST(PlausibilityClock, JustBelowItsLimit) {
  struct Case {
    double share;
    float sum_ms;
    int least_ticks;  ///< -1: never seen
    int most_ticks;
  };
  for (const Case& c : {Case{0.04, 76.9F, -1, -1}, Case{-0.04, 83.3F, -1, -1}, Case{0.05, 95.2F, -1, -1},
                        Case{-0.05, 105.3F, 580, 680}, Case{0.06, 113.2F, 370, 450}}) {
    Drive drive;
    drive.truth.speed_mps = 0.0F;
    const Drive::Lie lie = clock_faster_by(c.share);
    const int ticks = drive.until(Check::kClock, lie);
    EXPECT_GE(ticks, c.least_ticks) << c.share;
    EXPECT_LE(ticks, c.most_ticks) << c.share;
    for (int i = 1; i <= Drive::kRunTicks; ++i) drive.step(lie, 0.01F * static_cast<float>(i));
    EXPECT_NEAR(100.0F * drive.monitor.share(Check::kClock), c.sum_ms, 1.5F) << c.share;
  }
}

// PLAUS-003 PLAUS-011: with a clock 4 % fast or slow 10 m/s are driven for 30 s without a fault. Pose and speed come apart by
// 0.04 v, 0.077 s v or 0.083 s v in the end, of 0.5 m + 0.04 s v: reckoning sees it from 13.5 or 11.5 m/s on.
TEST(PlausibilityClock, FourPercentIsSeenByReckoningAtSpeed) {
  struct Case {
    double share;
    float speed_mps;
    bool seen;
  };
  for (const Case& c : {Case{0.04, 10.0F, false}, Case{0.04, 13.0F, false}, Case{0.04, 14.0F, true},
                        Case{-0.04, 10.0F, false}, Case{-0.04, 11.0F, false}, Case{-0.04, 12.0F, true}}) {
    Drive drive;
    drive.truth.speed_mps = c.speed_mps;
    EXPECT_EQ(drive.until(Check::kPoseAlong, clock_faster_by(c.share)) > 0, c.seen) << c.speed_mps;
    EXPECT_EQ(drive.monitor.faults(), c.seen ? bit(FaultBit::kPoseImplausible) : 0U) << c.speed_mps;
  }
}

}  // namespace
}  // namespace s4tp::ecu
