// Whose fault a touch nose to tail is: rows LAW-024 to LAW-026 of attribution.hpp's table.

#include <gtest/gtest.h>

#include <algorithm>

#include "sim_host/world/judge/attribution.hpp"
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

/// The one in front comes from the left lane over the line (y = 1.6) at t = -1, `gap_m` before the one
/// behind, at 8 m/s; that one drives 12 m/s.
Verdict cut_in(int front, double gap_m) {
  const Network network = test::judged_road(Rule::kFirstCome);
  const double until_s = -1.0 + gap_m / 4.0 + 0.05;
  return judged(network, -4.0, until_s, [&](double t) {
    const double y = t < -2.0 ? 3.2 : t > 0.0 ? 0.0 : -1.6 * t;
    const std::vector<CarState> cars{eastbound(front, 50.0 + gap_m + 5.0 + 8.0 * (t + 1.0), y, 8.0),
                                     eastbound(7 - front, 50.0 + 12.0 * (t + 1.0), 0.0, 12.0)};
    return front == 0 ? cars : std::vector<CarState>{cars[1], cars[0]};
  });
}

// LAW-024 12 m/s behind 8 m/s asks for 6.25 + 13^2 / 10 - 64 / 16 = 19.15 m; 3 m are a cut-in, whoever does
// it.
TEST(Attribution, CuttingIn) {
  EXPECT_EQ(pair(cut_in(0, 3.0)), std::pair(Fault::kEgo, Cause::kCutIn));
  EXPECT_EQ(pair(cut_in(7, 3.0)), std::pair(Fault::kOther, Cause::kCutIn));
}

/// The way from the south joins ours at x = 120, where we are at t = 0 with 5 m/s; 7 m behind us comes one with 10 m/s, which has
/// stood until `sets_off_s`, and touches us at t = 1.4, at x = 127.
Verdict run_into_beyond_the_merge(Rule our_rule, double sets_off_s = -5.0) {
  Network network = test::judged_road(our_rule);
  network.lanes[3].centre = map::Polyline(std::vector<map::Vec2>{{110.0, -10.0}, {120.0, 0.0}});
  network.lanes[3].successors = {5};
  const double way_m = network.lanes[3].centre.length_m();
  network.conflicts = {{2, 3, our_rule, 12.0, 20.0, way_m - 8.0, way_m}};
  return judged(network, -5.0, 1.5, [&](double t) {
    const double speed_mps = t < sets_off_s ? 0.0 : 10.0;
    CarState joins = eastbound(7, 120.0 - 12.0 + 10.0 * std::max(t, sets_off_s), 0.0, speed_mps);
    const double to_merge_m = 120.0 - joins.centre.x;
    if (to_merge_m > way_m) {
      joins = northbound(7, -10.0 - (to_merge_m - way_m), speed_mps);
    } else if (to_merge_m > 0.0) {
      const map::PolylinePose pose = network.lanes[3].centre.at(way_m - to_merge_m);
      joins.centre = pose.point;
      joins.heading_rad = pose.heading_rad;
      joins.lane = 3;
    }
    return std::vector<CarState>{eastbound(0, 120.05 + 5.0 * t, 0.0, 5.0), joins};
  });
}

// LAW-024 Merging ahead of one that has to give way is no cutting in, ahead of one that has priority it is: 10 m/s behind 5 m/s ask for
// 5.25 + 11^2 / 10 - 25 / 16 = 15.8 m.
TEST(Attribution, MergingWithPriorityIsNoCuttingIn) {
  EXPECT_EQ(pair(run_into_beyond_the_merge(Rule::kFirstHasPriority)),
            std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(run_into_beyond_the_merge(Rule::kFirstYields)), std::pair(Fault::kEgo, Cause::kCutIn));
}

// LAW-024 Ahead of one with priority that stands and has let us go, which sets off when we cannot stop any more (from x = 104 on, t = -3.2:
// 5 + 5^2 / 8 = 8.1 m), it is none, either: it is bound by that licence. One that sets off before has let nobody go.
TEST(Attribution, MergingByLicenceIsNoCuttingIn) {
  EXPECT_EQ(pair(run_into_beyond_the_merge(Rule::kFirstYields, -1.0)),
            std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(run_into_beyond_the_merge(Rule::kFirstYields, -3.5)), std::pair(Fault::kEgo, Cause::kCutIn));
}

// LAW-026 After 19.5 m it takes 4.9 s until they touch: the one behind had time; and so it had with 12 m,
// after 3 s.
TEST(Attribution, RunningIntoOneWhoCameLongAgo) {
  EXPECT_EQ(pair(cut_in(0, 19.5)), std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(cut_in(7, 12.0)), std::pair(Fault::kEgo, Cause::kRanInto));
}

// LAW-025 In the middle of a free road without reason: ours, though it runs into us.
TEST(Attribution, StoppingInALiveLane) {
  EXPECT_EQ(pair(judged(test::judged_road(Rule::kFirstYields), -6.0, 0.0, rear_ended(50.0))),
            std::pair(Fault::kEgo, Cause::kStopped));
}

// LAW-026 The same while we roll, or have stood for half a second only.
TEST(Attribution, BeingRunInto) {
  const Network network = test::judged_road(Rule::kFirstYields);
  EXPECT_EQ(pair(judged(network, -6.0, 0.0,
                        [](double t) {
                          return std::vector<CarState>{eastbound(0, 50.0 + 5.0 * t, 0.0, 5.0),
                                                       eastbound(7, 45.1 + 8.0 * t, 0.0, 8.0)};
                        })),
            std::pair(Fault::kOther, Cause::kRanInto));
  EXPECT_EQ(pair(judged(network, -6.0, 0.0,
                        [](double t) {
                          const bool stands = t > -0.5;
                          return std::vector<CarState>{
                              eastbound(0, stands ? 50.0 : 50.0 + 8.0 * (t + 0.5), 0.0, stands ? 0.0 : 8.0),
                              eastbound(7, 45.1 + 12.0 * t, 0.0, 12.0)};
                        })),
            std::pair(Fault::kOther, Cause::kRanInto));
}

}  // namespace
}  // namespace s4tp::judge
