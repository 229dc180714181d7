// Each reason to stand (reasons.hpp), by whom a standing ego that is run into is judged.

#include "sim_host/world/judge/reasons.hpp"

#include <gtest/gtest.h>

#include "tests/support/judged_touch.hpp"

namespace s4tp::judge {
namespace {

using map::Network;
using map::Rule;
using test::eastbound;
using test::judged;
using test::northbound;
using test::pair;
using test::rear_ended;
using traffic::CarState;
using traffic::Cause;
using traffic::Fault;

// LAW-030 Reasons: a queue 14 m ahead; 10 m before a zone where we have to yield (x = 96; the zone begins at
// 106); not where we have priority.
TEST(Reasons, QueueAndGivingWay) {
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstYields), -6.0, 0.0,
                        rear_ended(50.0, {eastbound(8, 69.0, 0.0, 0.0)}))),
            std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstYields), -6.0, 0.0, rear_ended(96.0))),
            std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstHasPriority), -6.0, 0.0, rear_ended(96.0))),
            std::pair(Fault::kEgo, Cause::kStopped));
}

// LAW-030 The left lane ends at x = 100 and the route needs the right one: standing at its end is a reason,
// 50 m before it is none.
TEST(Reasons, TheLastPlaceForALaneChange) {
  const Network network = test::judged_road(Rule::kFirstYields);
  const auto at = [&](double x) {
    return judged(network, -6.0, 0.0, [&](double t) {
      return std::vector<CarState>{eastbound(0, x, 3.2, 0.0), eastbound(7, x - 4.9 + 8.0 * t, 3.2, 8.0)};
    });
  };
  EXPECT_EQ(pair(at(95.0)), std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(at(45.0)), std::pair(Fault::kEgo, Cause::kStopped));
}

/// We have priority, stop at x = 86 at t = -1.5, 20 m before the zone, and are run into at t = 0. Car 8
/// creeps over the zone at 2 m/s from `entered_s` on.
Verdict stopped_for_one_who_creeps(double entered_s) {
  return judged(test::judged_road(Rule::kFirstHasPriority), -30.0, 0.0, [&](double t) {
    const bool stands = t > -1.5;
    return std::vector<CarState>{
        eastbound(0, stands ? 86.0 : 86.0 + 8.0 * (t + 1.5), 0.0, stands ? 0.0 : 8.0),
        eastbound(7, 81.1 + 12.0 * t, 0.0, 12.0), northbound(8, -4.0 + 2.0 * (t - entered_s), 2.0)};
  });
}

// LAW-030 It enters 2 s ago, gone after 4 s, when we were 24 m away at 8 m/s (3 s; 28 m to stop gently): it
// broke the law, reason enough. Entered 20 s ago, it was gone before we came.
TEST(Reasons, SomebodyBrokeTheLaw) {
  EXPECT_EQ(pair(stopped_for_one_who_creeps(-2.0)), std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(stopped_for_one_who_creeps(-20.0)), std::pair(Fault::kEgo, Cause::kStopped));
}

}  // namespace
}  // namespace s4tp::judge
