// Rates of episodes that come in roads.

#include "sim_host/metrics/clusters.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "sim_host/metrics/paired.hpp"
#include "sim_host/world/traffic/random.hpp"

namespace s4tp::metrics {
namespace {

/// Roads with `failures` of `episodes` each.
std::vector<Cluster> roads(const std::vector<int>& failures, int episodes) {
  std::vector<Cluster> all;
  for (const int failing : failures) {
    Cluster road;
    for (int i = 0; i < episodes; ++i) road.add(i < failing ? 1.0 : 0.0);
    all.push_back(road);
  }
  return all;
}

/// What a kind of road does to the failure rate.
struct Kind {
  double share;
  double rate;
};

struct Campaigns {
  double held = 0.0;    ///< share of campaigns whose clustered interval holds the true rate
  double simple = 0.0;  ///< the same of Wilson's over single episodes
};

Campaigns simulate(const std::vector<Kind>& kinds, int roads_each, int episodes, int campaigns) {
  double truth = 0.0;
  for (const Kind& kind : kinds) truth += kind.share * kind.rate;
  traffic::Random random(20);
  Campaigns held;
  for (int campaign = 0; campaign < campaigns; ++campaign) {
    std::vector<Cluster> clusters;
    double failures = 0.0;
    for (int i = 0; i < roads_each; ++i) {
      double left = random.uniform();
      std::size_t kind = 0;
      while (kind + 1 < kinds.size() && left >= kinds[kind].share) left -= kinds[kind++].share;
      Cluster road;
      for (int k = 0; k < episodes; ++k) road.add(random.uniform() < kinds[kind].rate ? 1.0 : 0.0);
      failures += road.sum;
      clusters.push_back(road);
    }
    const auto holds = [&](const Interval& interval) {
      return interval.low <= truth && truth <= interval.high;
    };
    held.held += holds(clustered_wilson(clusters)) ? 1.0 / campaigns : 0.0;
    held.simple += holds(wilson(failures, roads_each * episodes)) ? 1.0 / campaigns : 0.0;
  }
  return held;
}

// Ten roads of ten episodes, one of which fails them all, and the road that is always added, with 5 of 10:
// the mean is 15 / 110, the episodes' squared deviations sum to 15 - 15^2 / 110 = 12.95, the roads' to (10
// - 1.36)^2 + (5 - 1.36)^2 + 9 * 1.36^2 = 104.55, times 11 / 10: 115 / 12.95 = 8.88.
TEST(Clusters, DesignEffectOfFailuresThatGather) {
  EXPECT_NEAR(design_effect(roads({10, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 10)), 8.878, 1e-3);
}

// Spread evenly over the roads, failures tell as much as independent ones; one episode a road has no
// clusters.
TEST(Clusters, DesignEffectOfFailuresThatSpread) {
  EXPECT_EQ(design_effect(roads(std::vector<int>(20, 5), 10)), 1.0);
  EXPECT_NEAR(design_effect(roads({1, 0, 0, 1, 0, 0, 0, 0, 0, 1}, 1)), 1.1, 0.15);
}

// Without any failure the interval is that of a design effect of half a road's episodes: 300 roads of 10
// count as 600, and the upper bound is z^2 / (600 + z^2); never narrower than that of 3000 independent ones.
TEST(Clusters, NoFailureIsNoProofThatFailuresDoNotGather) {
  const std::vector<Cluster> none = roads(std::vector<int>(300, 0), 10);
  EXPECT_NEAR(design_effect(none), 5.0, 0.05);
  EXPECT_NEAR(clustered_wilson(none).high, 3.8415 / 603.8, 1e-4);
  EXPECT_GT(clustered_wilson(none).high, wilson(0, 3000).high);
  EXPECT_NEAR(clustered_wilson(none).low, 0.0, 1e-12);
}

// The more roads fail once, the less can be ruled out; the first few failures also show that they do not
// gather, which may narrow the interval by a few hundredths, no more.
TEST(Clusters, MoreFailuresRaiseTheUpperBound) {
  double before = 0.0;
  for (int failing = 0; failing <= 40; ++failing) {
    std::vector<int> spread(100, 0);
    for (int i = 0; i < failing; ++i) spread[static_cast<std::size_t>(i)] = 1;
    const double high = clustered_wilson(roads(spread, 10)).high;
    EXPECT_GT(high, (failing < 3 ? 0.95 : 1.0) * before) << failing;
    before = high;
  }
}

// 1000 campaigns of 300 roads x 10: 5 % of the roads fail a quarter of the time, the others 0.4 %. The
// clustered interval holds the truth in about 95 % of them, Wilson's over single episodes in far fewer.
TEST(Clusters, IntervalHoldsTheTruthWhereFailuresGather) {
  const Campaigns many = simulate({{0.05, 0.25}, {0.95, 0.004}}, 300, 10, 1000);
  EXPECT_GT(many.held, 0.925);
  EXPECT_LT(many.simple, 0.9);
}

// The same where failures are rare, where a road fails always or never, and with few roads.
TEST(Clusters, IntervalHoldsTheTruthAtTheEnds) {
  EXPECT_GT(simulate({{1.0, 0.002}}, 300, 10, 1000).held, 0.925);
  EXPECT_GT(simulate({{0.02, 1.0}, {0.98, 0.0}}, 300, 10, 1000).held, 0.925);
  EXPECT_GT(simulate({{0.1, 0.3}, {0.9, 0.02}}, 20, 10, 1000).held, 0.925);
  EXPECT_GT(simulate({{0.05, 0.5}, {0.95, 0.01}}, 100, 2, 1000).held, 0.925);
}

// With pairs that come in roads the bound is that of so many fewer pairs.
TEST(Paired, UpperBoundOfClusteredPairs) {
  EXPECT_EQ(difference_upper({400, 8, 4}, 4.0), difference_upper({100, 2, 1}));
  EXPECT_GT(difference_upper({400, 8, 4}, 4.0), difference_upper({400, 8, 4}));
}

}  // namespace
}  // namespace s4tp::metrics
