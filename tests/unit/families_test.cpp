// Results of roads put together by family.

#include "sim_host/campaign/families.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "sim_host/campaign/family_table.hpp"
#include "sim_host/view/result_tables.hpp"

namespace s4tp::campaign {
namespace {

/// Seed of an episode -> how it ended.
using Endings = std::vector<traffic::Ending>;
constexpr auto kGoal = traffic::Ending::kGoal;
constexpr auto kLate = traffic::Ending::kTimeOut;
constexpr auto kHit = traffic::Ending::kCollision;

/// Goals after 20 s, failures after 7 s.
void add(std::vector<EpisodeRow>& rows, const std::string& planner, bool guarded, const std::string& road,
         const Endings& endings) {
  for (std::size_t seed = 0; seed < endings.size(); ++seed) {
    EpisodeRow row;
    row.cell.planner = planner;
    row.cell.guarded = guarded;
    row.cell.scenario = road;
    row.metrics.seed = seed;
    row.metrics.ending = endings[seed];
    row.metrics.duration_s = endings[seed] == kGoal ? 20.0 : 7.0;
    row.metrics.collisions_at_fault = endings[seed] == kHit ? 1 : 0;
    rows.push_back(row);
  }
}

std::vector<CellResult> two_families() {
  std::vector<EpisodeRow> rows;
  for (const bool guarded : {true, false}) {
    add(rows, "s4tp", guarded, "merge_00007", guarded ? Endings{kGoal, kLate} : Endings{kGoal, kGoal});
    add(rows, "s4tp", guarded, "merge_00021", guarded ? Endings{kLate, kGoal} : Endings{kGoal, kGoal});
    add(rows, "s4tp", guarded, "turn_00000", guarded ? Endings{kGoal, kGoal} : Endings{kHit, kGoal});
  }
  add(rows, "sumo_driver", false, "merge_00007", {kLate, kLate});
  return collect(rows);
}

// Two roads of `merge`, one of `turn`, then all three; guarded first, as the rows come.
TEST(Families, StandInOrderWithTheirSum) {
  const std::vector<FamilyResult> families = by_family(two_families());
  ASSERT_EQ(families.size(), 7U);
  EXPECT_EQ(families[0].like.scenario, "merge");
  EXPECT_EQ(families[0].roads, 2);
  EXPECT_EQ(families[0].summary.episodes, 4);
  EXPECT_EQ(families[0].summary.success.count, 2);
  EXPECT_EQ(families[1].like.scenario, "turn");
  EXPECT_EQ(families[2].like.scenario, "all roads");
  EXPECT_EQ(families[2].roads, 3);
  EXPECT_EQ(families[2].summary.success.count, 4);
  EXPECT_FALSE(families[3].like.guarded);
  EXPECT_EQ(families[6].like.planner, "sumo_driver");
}

// Two goals after 20 s, two failures that count 80 s: 50 s on the mean.
TEST(Families, FailuresCountTheTimeLimit) {
  EXPECT_EQ(by_family(two_families())[0].restricted_mean_s, 50.0);
  EXPECT_EQ(by_family(two_families())[1].restricted_mean_s, 20.0);
}

// The clustered interval holds the rate and is wider than that of single episodes.
TEST(Families, IntervalIsClusteredByRoad) {
  for (const FamilyResult& family : by_family(two_families())) {
    EXPECT_LE(family.interval.low, family.summary.success.interval.low + 1e-12);
    EXPECT_GE(family.interval.high, family.summary.success.interval.high - 1e-12);
  }
}

// Guarded beside bare: of the four merges guarded alone fails two, of the two turns bare alone one, by its
// fault; s4tp guarded and bare beside SUMO's driver, on the one road it drove.
TEST(Families, ArePairedGuardedBesideBare) {
  const std::vector<FamilyPair> pairs = pair_families(two_families());
  ASSERT_EQ(pairs.size(), 5U);
  EXPECT_EQ(pairs[0].first.scenario, "merge");
  EXPECT_TRUE(pairs[0].first.guarded);
  EXPECT_FALSE(pairs[0].second.guarded);
  EXPECT_EQ(pairs[0].paired.pairs, 4);
  EXPECT_EQ(pairs[0].paired.only_first_fails, 2);
  EXPECT_EQ(pairs[0].first_restricted_mean_s, 50.0);
  EXPECT_EQ(pairs[0].second_restricted_mean_s, 20.0);
  EXPECT_EQ(pairs[1].first.scenario, "turn");
  EXPECT_EQ(pairs[1].paired.only_second_fails, 1);
  EXPECT_EQ(pairs[1].second_at_fault, 1);
  EXPECT_EQ(pairs[2].first.scenario, "all roads");
  EXPECT_EQ(pairs[2].paired.pairs, 6);
  EXPECT_GE(pairs[2].upper, metrics::difference_upper(pairs[2].paired));
  EXPECT_TRUE(pairs[3].first.guarded);
  EXPECT_EQ(pairs[3].second.planner, "sumo_driver");
  EXPECT_FALSE(pairs[4].first.guarded);
  EXPECT_EQ(pairs[4].paired.only_second_fails, 2);
}

// Scenarios without numbers are no families, and their results stay as they are.
TEST(Families, AreOnlyWhereAFamilyHasSeveralRoads) {
  std::vector<EpisodeRow> rows;
  add(rows, "s4tp", true, "merge", {kGoal});
  add(rows, "s4tp", true, "left_turn", {kGoal});
  add(rows, "s4tp", false, "merge", {kGoal});
  EXPECT_FALSE(has_families(collect(rows)));
  add(rows, "s4tp", true, "merge_1", {kGoal});
  EXPECT_TRUE(has_families(collect(rows)));
}

// Every family and every pair stands in the JSON and in the table.
TEST(Families, AreWritten) {
  const std::vector<CellResult> cells = two_families();
  const auto families = families_json(by_family(cells));
  ASSERT_EQ(families.size(), 7U);
  EXPECT_EQ(families[0].at("family"), "merge");
  EXPECT_EQ(families[0].at("roads"), 2);
  EXPECT_EQ(families[0].at("goals"), 2);
  EXPECT_EQ(families[0].at("restricted_mean_time_to_goal_s"), 50.0);
  EXPECT_EQ(family_pairs_json(pair_families(cells))[1].at("second_at_fault"), 1);
  std::ostringstream table;
  print_families(table, cells);
  EXPECT_NE(table.str().find("s4tp, guarded beside s4tp, bare"), std::string::npos);
  EXPECT_NE(table.str().find("all roads"), std::string::npos);
}

// The page has the same lines; where no family has several roads it has no such table.
TEST(Families, StandOnThePage) {
  const std::vector<CellResult> cells = two_families();
  view::Cells shown;
  for (const CellResult& cell : cells) shown.push_back(&cell);
  const std::string page = view::family_tables(shown);
  EXPECT_NE(page.find("<td>merge</td><td>s4tp, guarded</td><td>2</td><td>4</td><td><b>50.0</b></td>"),
            std::string::npos);
  EXPECT_NE(page.find("<td>turn</td><td>s4tp, guarded</td><td>s4tp, bare</td><td>2</td><td>0</td><td>1</td>"),
            std::string::npos);
  EXPECT_EQ(view::family_tables({&cells[0]}), "");
}

// With one driver there is nobody to compare it with, and no table for that.
TEST(Families, AloneAreComparedWithNobody) {
  std::vector<EpisodeRow> rows;
  add(rows, "s4tp", true, "merge_1", {kGoal});
  add(rows, "s4tp", true, "merge_2", {kGoal});
  const std::vector<CellResult> cells = collect(rows);
  const std::string page = view::family_tables({&cells[0], &cells[1]});
  EXPECT_NE(page.find("families"), std::string::npos);
  EXPECT_EQ(page.find("family_pairs"), std::string::npos);
}

}  // namespace
}  // namespace s4tp::campaign
