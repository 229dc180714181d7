// The law's formulas and licences, by hand.

#include "sim_host/world/judge/law.hpp"

#include <gtest/gtest.h>

namespace s4tp::judge {
namespace {

/// Gains 3 m/s^2 at most to 1.2 times the limit of 10 m/s, so 12.
Law law() {
  Law law;
  law.acceleration_mps2 = 3.0;
  law.over_limit = 1.2;
  return law;
}

/// A crossing entered by one that will be gone after `gone_after_s`, the other `to_zone_m` away at 12 m/s.
Entry crossing(double gone_after_s, double to_zone_m) {
  Entry entry;
  entry.gone_after_s = gone_after_s;
  entry.other_to_zone_m = to_zone_m;
  entry.other_to_end_m = to_zone_m + 8.0;
  entry.other_mps = 12.0;
  entry.other_limit_mps = 10.0;
  return entry;
}

// 10 m/s behind 5: 0.5 s at 2 m/s^2 is 5 + 0.25 m to 11 m/s, then 11^2 / 10; the one ahead stops in 25 / 16.
// A fast one ahead asks for nothing.
TEST(Law, RssGap) {
  EXPECT_NEAR(rss_gap_m({}, 10.0, 5.0), 5.25 + 12.1 - 1.5625, 1e-12);
  EXPECT_EQ(rss_gap_m({}, 0.0, 20.0), 0.0);
}

// From 9 m/s: 1 s at 3 m/s^2 reaches the top of 12 and covers 10.5 m, the other 0.5 s 6 m; then 144 / 4.
TEST(Law, StoppingWay) {
  EXPECT_NEAR(stopping_m(9.0, 1.5, 3.0, 12.0, 2.0), 10.5 + 6.0 + 36.0, 1e-12);
}

// At 8 m/s one second and 64 / 8 = 8 m: 16 m, to the centimetre.
TEST(Law, ADutyBindsWhoCanStop) {
  EXPECT_TRUE(can_stop(law(), 8.0, 16.0));
  EXPECT_FALSE(can_stop(law(), 8.0, 15.99));
}

// LAW-001 12 m/s for 3 s are 36 m: who is gone by then may go before the other; a little later it
// needs another licence.
TEST(Licence, ClearIsWhoWillBeGone) {
  EXPECT_EQ(licence_of(law(), crossing(3.0, 36.0)), Licence::kClear);
  EXPECT_EQ(licence_of(law(), crossing(3.01, 36.0)), Licence::kNone);
  EXPECT_EQ(licence_of(law(), crossing(0.5, -1.0)), Licence::kNone) << "the other is on the zone";
}

// LAW-001 It is reckoned with the other's speeding up: from 6 m/s to 12 takes 2 s and 18 m, so 30 m take 3 s.
TEST(Licence, TheOtherMaySpeedUp) {
  Entry entry = crossing(3.0, 30.0);
  entry.other_mps = 6.0;
  EXPECT_EQ(licence_of(law(), entry), Licence::kClear);
  entry.other_to_zone_m = 29.9;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
}

// LAW-001 Into one lane: gone after 2 s at 12 m/s, the other at 12 m/s then has the RSS gap of two at 12:
// 6.25 + 16.9 - 9 = 14.15 m, if it is 24 + 5 + 14.15 m from the end.
TEST(Licence, MergingClearLeavesTheGap) {
  Entry entry = crossing(2.0, 35.0);
  entry.merging = true;
  entry.gone_mps = 12.0;
  entry.other_to_end_m = 43.16;
  EXPECT_EQ(licence_of(law(), entry), Licence::kClear);
  entry.other_to_end_m = 43.14;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
}

// LAW-002 1.5 s at 12 m/s and 144 / 4 are 54 m to stop gently; one that does not see us is asked nothing.
TEST(Licence, TheOtherCanStop) {
  Entry entry = crossing(60.0, 54.0);
  EXPECT_EQ(licence_of(law(), entry), Licence::kCanStop);
  entry.other_to_zone_m = 53.9;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
  entry.other_to_zone_m = 54.0;
  entry.in_sight = false;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
}

// LAW-003 The other stands 2 m before the zone and has seen our nose for 0.7 s; not a moment less; where both
// have stood for 2 s any one may go, seen or not; never while the other stands on the zone.
TEST(Licence, TheOtherStands) {
  Entry entry = crossing(4.0, 2.0);
  entry.other_mps = 0.0;
  entry.other_stood_s = 1.0;
  entry.shown_s = 0.7;
  EXPECT_EQ(licence_of(law(), entry), Licence::kStands);
  entry.shown_s = 0.6;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
  entry.both_stood_s = 2.0;
  EXPECT_EQ(licence_of(law(), entry), Licence::kStands);
  entry.other_to_zone_m = 0.0;
  EXPECT_EQ(licence_of(law(), entry), Licence::kNone);
}

}  // namespace
}  // namespace s4tp::judge
