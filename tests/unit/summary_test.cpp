// Counts, intervals and paired comparisons.

#include "sim_host/metrics/summary.hpp"

#include <gtest/gtest.h>

#include "sim_host/metrics/metrics.hpp"
#include "sim_host/metrics/paired.hpp"

namespace s4tp::metrics {
namespace {

using traffic::CarState;
using traffic::Ending;
using traffic::Recording;
using traffic::Snapshot;

// Nearest rank: of 1 .. 20 the 5th percentile is the 1st value, of 1 .. 21 the 2nd; the median of three the
// 2nd.
TEST(Summary, Percentile) {
  std::vector<double> values;
  for (int i = 20; i > 0; --i) values.push_back(i);
  EXPECT_EQ(percentile(values, 0.05), 1.0);
  values.push_back(21.0);
  EXPECT_EQ(percentile(values, 0.05), 2.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 0.5), 2.0);
}

// 1 and 8 discordant pairs: 2 (1 + 9) / 2^9 = 0.0390625; 0 and 5: 2 / 2^5 = 0.0625, not yet better; equal
// numbers or none: 1.
TEST(Paired, McNemarExact) {
  EXPECT_NEAR(mcnemar_p({100, 1, 8}), 0.0390625, 1e-12);
  EXPECT_NEAR(mcnemar_p({100, 0, 5}), 0.0625, 1e-12);
  EXPECT_NEAR(mcnemar_p({100, 3, 3}), 1.0, 1e-12);
  EXPECT_EQ(mcnemar_p({100, 0, 0}), 1.0);
  EXPECT_TRUE(first_is_better({100, 1, 8}));
  EXPECT_FALSE(first_is_better({100, 8, 1}));
  EXPECT_FALSE(first_is_better({100, 0, 5}));
}

// Without discordant pairs z^2 / (n + z^2): 3.8415 / 103.8415 = 3.70 % of 100, still under 1 % from 381 on.
TEST(Paired, UpperBoundWithoutDifference) {
  EXPECT_NEAR(difference_upper({100, 0, 0}), 3.841459 / 103.841459, 1e-6);
  EXPECT_FALSE(first_is_no_worse({380, 0, 0}));
  EXPECT_TRUE(first_is_no_worse({381, 0, 0}));
}

// Where only the first ever fails alone, the difference is a plain rate, and the bound Wilson's.
TEST(Paired, UpperBoundIsWilsonsForOneKindOfPair) {
  EXPECT_NEAR(difference_upper({50, 7, 0}), wilson(7, 50).high, 1e-9);
}

// Failing alone more often in the second counts for the first: 0 and 10 of 500 bound the difference below
// zero, 10 and 0 above 2 %.
TEST(Paired, UpperBoundFollowsTheSign) {
  EXPECT_LT(difference_upper({500, 0, 10}), 0.0);
  EXPECT_GT(difference_upper({500, 10, 0}), 0.02);
  EXPECT_LT(difference_upper({500, 2, 2}), difference_upper({500, 3, 2}));
}

// method.md: 500 of 500 only bounds the failure rate below 0.8 %. 16 of 20: 58.4 .. 91.9 % (tabulated).
TEST(Summary, WilsonInterval) {
  EXPECT_NEAR(wilson(500, 500).low, 0.9924, 5e-4);
  EXPECT_NEAR(wilson(16, 20).low, 0.584, 1e-3);
  EXPECT_NEAR(wilson(16, 20).high, 0.919, 1e-3);
  EXPECT_EQ(wilson(0, 0).high, 1.0);
}

// Two goals after 4 and 6 s and one collision of ours: 5 s on average, one of three lost; one goal by 5 s, as the collision, sooner
// than that, is none. Encounters: shares count what lies beyond the limit, 1.5 s is not below 1.5 s.
TEST(Summary, CountsAndAverages) {
  std::vector<EpisodeMetrics> episodes(3);
  episodes[0].ending = episodes[1].ending = Ending::kGoal;
  episodes[0].duration_s = 4.0;
  episodes[1].duration_s = 6.0;
  for (EpisodeMetrics& episode : episodes) episode.in_time_s = 5.0;
  episodes[2].ending = Ending::kCollision;
  episodes[2].collisions_at_fault = 1;
  episodes[2].cause = "ran into";
  episodes[0].encounters.near_misses = 3;
  episodes[0].encounters.min_post_encroachment_s = 1.4;
  episodes[0].encounters.imposed_braking_mps2 = 2.5;
  episodes[1].encounters.imposed_braking_mps2 = 3.5;
  episodes[1].encounters.min_time_gap_s = 1.5;
  const Summary sum = summarize(episodes);
  EXPECT_EQ(sum.success.count, 2);
  EXPECT_EQ(sum.in_time.count, 1);
  EXPECT_EQ(sum.in_time_s, 5.0);
  EXPECT_DOUBLE_EQ(sum.seconds_to_goal, 5.0);
  EXPECT_EQ(sum.collision.count, 1);
  EXPECT_EQ(sum.at_fault.count, 1);
  EXPECT_NEAR(sum.at_fault.share, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(sum.causes, (std::map<std::string, int>{{"ran into", 1}}));
  EXPECT_DOUBLE_EQ(sum.near_misses, 1.0);
  EXPECT_EQ(sum.close_encroachment.count, 1);
  EXPECT_DOUBLE_EQ(sum.imposed_braking_mps2, 2.0);
  EXPECT_EQ(sum.imposed_over_2.count, 2);
  EXPECT_EQ(sum.imposed_over_3.count, 1);
  EXPECT_EQ(sum.pressed.count, 0);
}

}  // namespace
}  // namespace s4tp::metrics
