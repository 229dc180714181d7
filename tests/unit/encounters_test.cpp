// How the ego met others, from drives on the judge's road.

#include "sim_host/metrics/encounters.hpp"

#include <gtest/gtest.h>

#include "tests/support/judged_road.hpp"

namespace s4tp::metrics {
namespace {

using map::Rule;
using test::eastbound;
using test::northbound;
using traffic::CarState;

Encounters met(Rule rule, double from_s, double until_s, const test::Drive& drive) {
  const map::Network network = test::judged_road(rule);
  const map::RouteGuide guide = test::eastwards(network);
  return encounters_of({}, judge::Evidence(network, test::recorded(from_s, until_s, drive), &guide),
                       test::kStart_s + from_s);
}

/// Both at 10 m/s; the ego's centre is on the crossing (x = 110) at t = 0, the other's `later_s` after.
test::Drive crossing(double later_s) {
  return [=](double t) {
    return std::vector<CarState>{eastbound(0, 110.0 + 10.0 * t, 0.0, 10.0),
                                 northbound(7, 10.0 * (t - later_s), 10.0)};
  };
}

// Half a length and half a width of each: the ego's rear leaves the other's strip (x = 110.9) at t = 0.34,
// the other's nose comes to y = -0.9, our strip, 0.34 s before it is on the crossing. So 1.5 s apart are 0.82
// s. MET-001 MET-002 In tenths: our last snapshot on it is 0.3, its first at 1.2: 0.9 s, a near miss; 1.8 s
// apart are none.
TEST(Encounters, PostEncroachmentTime) {
  EXPECT_NEAR(met(Rule::kFirstYields, -5.0, 5.0, crossing(1.5)).min_post_encroachment_s, 0.9, 1e-6);
  EXPECT_EQ(met(Rule::kFirstYields, -5.0, 5.0, crossing(1.5)).near_misses, 1);
  EXPECT_NEAR(met(Rule::kFirstYields, -5.0, 5.0, crossing(-1.8)).min_post_encroachment_s, 1.2, 1e-6);
  EXPECT_EQ(met(Rule::kFirstYields, -5.0, 5.0, crossing(-1.8)).near_misses, 0);
}

// MET-002 Who touches is no near miss; who is on no common ground was not met.
TEST(Encounters, TouchesAreNoNearMisses) {
  const Encounters touched = met(Rule::kFirstYields, -5.0, 5.0, crossing(0.0));
  EXPECT_EQ(touched.min_post_encroachment_s, 0.0);
  EXPECT_EQ(touched.near_misses, 0);
  const Encounters alone = met(Rule::kFirstYields, -5.0, -2.0, crossing(0.0));
  EXPECT_EQ(alone.min_post_encroachment_s, kApart_s);
}

/// Car 7 brakes with 2.5 m/s^2 `gap_m` behind the ego, which drives 8 m/s, at 12 m/s.
test::Drive braking_behind(double gap_m) {
  return [=](double t) {
    CarState behind = eastbound(7, 50.0 - 5.0 - gap_m + 12.0 * t, 0.0, 12.0);
    behind.acceleration_mps2 = -2.5;
    return std::vector<CarState>{eastbound(0, 50.0 + 8.0 * t, 0.0, 8.0), behind};
  };
}

// MET-004 2 s at 12 m/s and (144 - 64) / 4 are 44 m: nearer than that it is for us that it brakes.
TEST(Encounters, ImposedBrakingOnOneBehind) {
  EXPECT_EQ(met(Rule::kFirstYields, 0.0, 0.1, braking_behind(43.0)).imposed_braking_mps2, 2.5);
  EXPECT_EQ(met(Rule::kFirstYields, 0.0, 0.1, braking_behind(45.5)).imposed_braking_mps2, 0.0);
}

// MET-004 With somebody between us it is for that one.
TEST(Encounters, BrakingForAnotherIsNotImposed) {
  const auto drive = [](double t) {
    std::vector<CarState> cars = braking_behind(30.0)(t);
    cars.push_back(eastbound(8, 38.0 + 8.0 * t, 0.0, 8.0));
    return cars;
  };
  EXPECT_EQ(met(Rule::kFirstYields, 0.0, 0.1, drive).imposed_braking_mps2, 0.0);
}

/// The ego rolls over the crossing at 2 m/s; car 7, 30 m before the zone at 10 m/s, brakes with 3.5 m/s^2.
std::vector<CarState> rolling_before_one(double t) {
  CarState other = northbound(7, -34.0 + 10.0 * t, 10.0);
  other.acceleration_mps2 = -3.5;
  return {eastbound(0, 107.0 + 2.0 * t, 0.0, 2.0), other};
}

// MET-004 On a zone where the other has priority we impose it; where it must give way it only does its duty.
TEST(Encounters, ImposedBrakingOnAZone) {
  EXPECT_EQ(met(Rule::kFirstYields, 0.0, 0.5, rolling_before_one).imposed_braking_mps2, 3.5);
  EXPECT_EQ(met(Rule::kFirstHasPriority, 0.0, 0.5, rolling_before_one).imposed_braking_mps2, 0.0);
}

/// Car 7 comes from the left lane over the line at t = 0, 6 m before us, as fast as we are.
std::vector<CarState> cut_in_on(double t) {
  return {eastbound(0, 20.0 + 10.0 * t, 0.0, 10.0), eastbound(7, 31.0 + 10.0 * t,
                                                              t < -0.5  ? 3.2
                                                              : t > 0.5 ? 0.0
                                                                        : 1.6 - 3.2 * t,
                                                              10.0)};
}

// MET-005 10 m/s behind 10 m/s owe 5.25 + 12.1 - 6.25 = 11.1 m. One that cut in has 1 s to be let go: of the
// 2 s after it the first does not count.
TEST(Encounters, RssHasGraceAfterACutIn) {
  const Encounters met_it = met(Rule::kFirstYields, -1.0, 2.0, cut_in_on);
  EXPECT_EQ(met_it.rss_violations, 1);
  EXPECT_NEAR(met_it.rss_violation_share, 10.0 / 31.0, 1.5 / 31.0);
}

// MET-003 Following of our own choice at 0.6 s presses nobody; one that cuts in at 0.6 s does; so does one
// behind.
TEST(Encounters, PressedByOthers) {
  const auto following = [](double t) {
    return std::vector<CarState>{eastbound(0, 20.0 + 10.0 * t, 0.0, 10.0),
                                 eastbound(7, 31.0 + 10.0 * t, 0.0, 10.0)};
  };
  const auto followed = [](double t) {
    return std::vector<CarState>{eastbound(0, 31.0 + 10.0 * t, 0.0, 10.0),
                                 eastbound(7, 20.0 + 10.0 * t, 0.0, 10.0)};
  };
  EXPECT_EQ(met(Rule::kFirstYields, 0.0, 3.0, following).min_time_gap_s, kApart_s);
  EXPECT_NEAR(met(Rule::kFirstYields, -1.0, 2.0, cut_in_on).min_time_gap_s, 0.6, 1e-6);
  EXPECT_NEAR(met(Rule::kFirstYields, 0.0, 3.0, followed).min_time_gap_s, 0.6, 1e-6);
}

}  // namespace
}  // namespace s4tp::metrics
