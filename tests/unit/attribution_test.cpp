// Whose fault and why: each row of attribution.hpp's table.

#include "sim_host/world/judge/attribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/judged_touch.hpp"

namespace s4tp::judge {
namespace {

using map::Network;
using map::Rule;
using test::eastbound;
using test::judged;
using test::northbound;
using test::pair;
using traffic::CarState;
using traffic::Cause;
using traffic::Fault;

/// Both at 8 m/s: the ego at x = 104 + 8 t, the other at y = -6 + 8 t: boxes touch at t = 0.5.
std::vector<CarState> both_cross(double t) {
  return {eastbound(0, 104.0 + 8.0 * t, 0.0, 8.0), northbound(7, -6.0 + 8.0 * t, 8.0)};
}

// LAW-018 We have stood for 5 s without reason; one that comes at 20 m/s has been in the world for 0.9 s, 18 m, or for 1.1 s. Only the
// second could have been answered.
TEST(Attribution, WhoComesIntoTheWorldIsAnsweredNoSooner) {
  const auto touched_after = [](double known_s) {
    return judged(test::judged_road(Rule::kFirstYields), -5.0, 0.0, [&](double t) {
      std::vector<CarState> cars{eastbound(0, 60.0, 0.0, 0.0)};
      if (t > -known_s + 1e-6) cars.push_back(eastbound(7, 55.0 + 20.0 * t, 0.0, 20.0));
      return cars;
    });
  };
  EXPECT_EQ(pair(touched_after(0.9)), std::pair(Fault::kOther, Cause::kAppeared));
  EXPECT_EQ(pair(touched_after(1.1)), std::pair(Fault::kEgo, Cause::kStopped));
}

/// We stand at x, y from t = `stood_from_s` on, before a zone that we yield at; a lorry of 12 m comes from the south as if to turn
/// left, headed 126 degrees from us, and touches us at t = 0.
Verdict swept_by_a_lorry(double x, double y, double stood_from_s) {
  return judged(test::judged_road(Rule::kFirstYields), -6.0, 0.0, [&](double t) {
    const bool stands = t >= stood_from_s;
    CarState lorry = northbound(7, -8.0 + 4.0 * t, 4.0);
    lorry.centre.x = x + 4.0;
    lorry.heading_rad = 2.2;
    lorry.length_m = 12.0;
    lorry.width_m = 2.5;
    lorry.centre.y = y + 3.0 * t;
    return std::vector<CarState>{
        eastbound(0, stands ? x : x + 8.0 * (t - stood_from_s), y, stands ? 0.0 : 8.0), lorry};
  });
}

// LAW-019 At x = 102, 4 m before the zone, we have stood for 2 s when it sweeps into us: its fault. After half a second it is not said to
// be, nor where we stand 1 m over our line (half a lane of 1.6 m, half a car of 0.9 m), nor on the zone, at 108 m.
TEST(Attribution, NobodySweepsWhoStandsByRight) {
  EXPECT_EQ(pair(swept_by_a_lorry(102.0, 0.0, -2.0)), std::pair(Fault::kOther, Cause::kIntoRightful));
  EXPECT_EQ(swept_by_a_lorry(102.0, 0.0, -0.5).fault, Fault::kEgo);
  EXPECT_EQ(swept_by_a_lorry(102.0, 1.7, -2.0).fault, Fault::kEgo);
  EXPECT_EQ(swept_by_a_lorry(108.0, 0.0, -2.0).fault, Fault::kEgo);
}

// LAW-020 Who had to yield entered at x = 106, 0.25 s after t = 0, when the other was 0 m before the zone.
TEST(Attribution, EnteringWithoutLicence) {
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstYields), -5.0, 0.5, both_cross)),
            std::pair(Fault::kEgo, Cause::kEntered));
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstHasPriority), -5.0, 0.5, both_cross)),
            std::pair(Fault::kOther, Cause::kEntered));
}

/// The ego enters at t = -9.5 at 2 m/s, when the other, who has priority, is 76 m away at 8 m/s, and stands
/// at x = 109 from t = -8 on; the other does not brake. Stopping gently from 8 m/s takes at most 72 m.
std::vector<CarState> ego_stands_on_the_zone(double t) {
  const bool stands = t > -8.0;
  return {eastbound(0, stands ? 109.0 : 109.0 + 2.0 * (t + 8.0), 0.0, stands ? 0.0 : 2.0),
          northbound(7, -3.4 + 8.0 * t, 8.0)};
}

/// Gains 1 m/s^2 up to the limit of 8 m/s: the arithmetic of the tests' speeds.
Law gentle() {
  Law law;
  law.acceleration_mps2 = 1.0;
  law.over_limit = 1.0;
  return law;
}

Network slow_road(Rule rule) {
  Network network = test::judged_road(rule);
  for (map::Lane& lane : network.lanes) lane.speed_limit_mps = 8.0;
  return network;
}

/// The ego stands 0.8 m before the zone, in sight of one that stands 0.5 m before it, sets off at t = 0 with 3 m/s^2 and goes in at
/// t = 0.73; at t = 0.3 it needs 0.9 m and 0.1 m to stop, and 0.67 m are left. The other sets off at `their_start_s` with 2 m/s^2.
Verdict both_set_off(double their_start_s, double until_s) {
  return judged(test::judged_road(Rule::kFirstYields), -5.0, until_s, [&](double t) {
    const double ours_s = std::max(0.0, t);
    const double theirs_s = std::max(0.0, t - their_start_s);
    return std::vector<CarState>{eastbound(0, 105.2 + 1.5 * ours_s * ours_s, 0.0, 3.0 * ours_s),
                                 northbound(7, -4.5 + theirs_s * theirs_s, 2.0 * theirs_s)};
  });
}

// LAW-005 Whoever had let us go and sets off when we could not stop any more is bound; one that sets off before is not, and is
// faster than 0.3 m/s, so that it does not stand, by then.
TEST(Attribution, ALicenceLostTooLateToStopHolds) {
  EXPECT_EQ(pair(both_set_off(0.4, 1.5)), std::pair(Fault::kOther, Cause::kIntoRightful));
  EXPECT_EQ(pair(both_set_off(-0.1, 1.2)), std::pair(Fault::kEgo, Cause::kEntered));
}

/// The ego goes on at 8 m/s, from x = 90 (t = -1.75) on unable to stop (8 + 8 m), and enters at t = 0.25. The other comes into the world
/// at `from_s`, 2 m/s fast, and is at its zone at t = 0.4 and in the ego's side at t = 1.2.
Verdict it_comes_into_the_world(double from_s) {
  return judged(test::judged_road(Rule::kFirstYields), -5.0, 1.2, [&](double t) {
    std::vector<CarState> cars{eastbound(0, 104.0 + 8.0 * t, 0.0, 8.0)};
    if (t >= from_s) cars.push_back(northbound(7, -4.8 + 2.0 * t, 2.0));
    return cars;
  });
}

// LAW-005 One that comes into the world when we cannot stop any more finds the ground taken, 3.8 m before it, where 2.5 do (2 + 0.5 m);
// one that was there half a second before that is entered before; so is one that could not stop, 1.8 m before it.
TEST(Attribution, WhoComesIntoTheWorldFindsTheGroundTaken) {
  EXPECT_EQ(pair(it_comes_into_the_world(-1.5)), std::pair(Fault::kOther, Cause::kIntoRightful));
  EXPECT_EQ(pair(it_comes_into_the_world(-2.25)), std::pair(Fault::kEgo, Cause::kEntered));
  EXPECT_EQ(pair(it_comes_into_the_world(-0.5)), std::pair(Fault::kEgo, Cause::kEntered));
}

// LAW-022 Licensed, as 1.5 s and 8^2 / 4 are 28 m: the other should have stopped, although we had to yield.
TEST(Attribution, DrivingIntoOneThereByRight) {
  const Network network = slow_road(Rule::kFirstYields);
  const std::vector<traffic::Snapshot> history = test::recorded(-12.0, 0.0, ego_stands_on_the_zone);
  EXPECT_EQ(pair(attribute(network, test::eastwards(network), history, 7, gentle())),
            std::pair(Fault::kOther, Cause::kIntoRightful));
}

/// The other one, who has to yield, enters at 2 m/s when we are 57 m from the zone, and stands with its front at y = -1 from t = -8
/// on; we come to a stand at x = 107, 0.1 m from it, at `stand_s`; from t = 0 on it drives on with 1 m/s.
Verdict it_drives_on_into_us(double stand_s) {
  const Network network = slow_road(Rule::kFirstHasPriority);
  const std::vector<traffic::Snapshot> history = test::recorded(-12.0, 0.2, [&](double t) {
    const double north_y = t < -8.0 ? -3.5 + 2.0 * (t + 8.0) : t < 0.0 ? -3.5 : -3.5 + t;
    return std::vector<CarState>{
        eastbound(0, std::min(107.0, 107.0 + 8.0 * (t - stand_s)), 0.0, t < stand_s ? 8.0 : 0.0),
        northbound(7, north_y,
                   t < -8.0  ? 2.0
                   : t < 0.0 ? 0.0
                             : 1.0)};
  });
  return attribute(network, test::eastwards(network), history, 7, gentle());
}

// LAW-022 Nobody drives into anything while it stands: after 2 s it is the other one who does. After 0.3 s it is us, who came to where
// it was by licence: 59 m before the zone we could have stopped in 12 + 16 m.
TEST(Attribution, WhoStandsDrivesIntoNothing) {
  EXPECT_EQ(pair(it_drives_on_into_us(-2.0)), std::pair(Fault::kOther, Cause::kIntoRightful));
  EXPECT_EQ(pair(it_drives_on_into_us(-0.3)), std::pair(Fault::kEgo, Cause::kIntoRightful));
}

// LAW-021 The same behind a queue that already stood at x = 117 when we entered: our rear cannot leave the
// zone (114 - 5 < 117 - 5 < 114).
TEST(Attribution, EnteringWithoutRoomBeyond) {
  const Network network = slow_road(Rule::kFirstYields);
  const std::vector<traffic::Snapshot> history = test::recorded(-12.0, 0.0, [](double t) {
    std::vector<CarState> cars = ego_stands_on_the_zone(t);
    cars.push_back(eastbound(8, 117.0, 0.0, 0.0));
    return cars;
  });
  EXPECT_EQ(pair(attribute(network, test::eastwards(network), history, 7, gentle())),
            std::pair(Fault::kEgo, Cause::kNoRoom));
}

// LAW-023 First come: 106 m reached 0.25 s after t = 0, -4 m at the same time; a tenth of a second decides.
TEST(Attribution, FirstComeGoesToTheEarlierOne) {
  const Network network = test::judged_road(Rule::kFirstCome);
  const auto met = [&](double lead_s) {
    return judged(network, -5.0, 0.5, [&](double t) {
      return std::vector<CarState>{eastbound(0, 104.0 + 8.0 * (t + lead_s), 0.0, 8.0),
                                   northbound(7, -6.0 + 8.0 * t, 8.0)};
    });
  };
  EXPECT_EQ(pair(met(0.1)), std::pair(Fault::kOther, Cause::kEnteredLater));
  EXPECT_EQ(pair(met(-0.1)), std::pair(Fault::kEgo, Cause::kEnteredLater));
}

/// Head-on at x = 60: the ego at y, car 7 on its way west at its y.
Verdict head_on(double ego_y, double their_y) {
  return judged(test::judged_road(Rule::kFirstCome), -2.0, 0.0, [&](double t) {
    CarState against = eastbound(7, 64.9 - 8.0 * t, their_y, 8.0);
    against.heading_rad = 4.0 * std::atan(1.0);
    against.lane = 7;
    CarState ego = eastbound(0, 60.0 + 8.0 * t, ego_y, 8.0);
    ego.lane = 1;
    return std::vector<CarState>{ego, against};
  });
}

// LAW-027 In the left lane (1.6 to 4.8 m) we are met by one at 4.5 m, 0.3 m of it in its own; the other way
// round; both.
TEST(Attribution, OnTheWrongSide) {
  EXPECT_EQ(pair(head_on(3.2, 4.5)), std::pair(Fault::kOther, Cause::kOncoming));
  EXPECT_EQ(pair(head_on(5.0, 6.4)), std::pair(Fault::kEgo, Cause::kOncoming));
  EXPECT_EQ(pair(head_on(4.5, 5.0)), std::pair(Fault::kEgo, Cause::kOncoming));
}

/// Beside each other at 10 m/s, the ego at its y in the right lane, car 7 in the left.
Verdict side_by_side(double ego_y, double their_y) {
  return judged(test::judged_road(Rule::kFirstCome), -2.0, 0.0, [&](double t) {
    CarState ego = eastbound(0, 50.0 + 10.0 * t, ego_y, 10.0);
    ego.lane = 0;
    CarState other = eastbound(7, 51.0 + 10.0 * t, their_y, 10.0);
    other.lane = 1;
    return std::vector<CarState>{ego, other};
  });
}

// LAW-028 Its box hangs 0.75 m over the line, ours keeps its lane; the other way round; both.
TEST(Attribution, OverTheLine) {
  EXPECT_EQ(pair(side_by_side(0.0, 1.75)), std::pair(Fault::kOther, Cause::kChangedLane));
  EXPECT_EQ(pair(side_by_side(1.45, 3.2)), std::pair(Fault::kEgo, Cause::kChangedLane));
  EXPECT_EQ(pair(side_by_side(1.0, 2.7)), std::pair(Fault::kEgo, Cause::kChangedLane));
}

/// Both from the left lane into the right one, a metre behind each other; each one's centre comes over at its time.
Verdict both_come_over(double ego_s, double its_s) {
  return judged(test::judged_road(Rule::kFirstCome), -2.5, 0.0, [&](double t) {
    CarState ego = eastbound(0, 50.0 + 10.0 * t, t < ego_s ? 2.2 : 0.4, 10.0);
    ego.lane = t < ego_s ? 1 : 0;
    CarState other = eastbound(7, 51.0 + 10.0 * t, t < its_s ? 2.2 : 0.4, 10.0);
    other.lane = t < its_s ? 1 : 0;
    return std::vector<CarState>{ego, other};
  });
}

// LAW-028 It comes over beside us, who have been over for a second; the other way round; it was over half a second before us;
// both at once.
TEST(Attribution, WhoComesOverLast) {
  constexpr double kNotYet = 1.0;
  EXPECT_EQ(pair(both_come_over(-1.0, kNotYet)), std::pair(Fault::kOther, Cause::kChangedLane));
  EXPECT_EQ(pair(both_come_over(kNotYet, -1.0)), std::pair(Fault::kEgo, Cause::kChangedLane));
  EXPECT_EQ(pair(both_come_over(-1.0, -1.5)), std::pair(Fault::kEgo, Cause::kChangedLane));
  EXPECT_EQ(pair(both_come_over(-1.0, -1.0)), std::pair(Fault::kEgo, Cause::kChangedLane));
}

// LAW-029 Off every lane there is no row: ours.
TEST(Attribution, UnclearIsOurs) {
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstCome), -2.0, 0.0,
                        [](double t) {
                          CarState ego = eastbound(0, 50.0 + 10.0 * t, -5.0, 10.0);
                          ego.lane = map::kNoLane;
                          return std::vector<CarState>{ego, eastbound(7, 51.0 + 10.0 * t, -4.0, 10.0)};
                        })),
            std::pair(Fault::kEgo, Cause::kUnclear));
}

// Every cause has words of its own, from both sides.
TEST(Attribution, CausesHaveWords) {
  EXPECT_STREQ(traffic::cause_words(Fault::kEgo, Cause::kEntered), "entered without licence");
  EXPECT_STREQ(traffic::cause_words(Fault::kOther, Cause::kEntered), "was not given way");
}

}  // namespace
}  // namespace s4tp::judge
