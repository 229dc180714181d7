// The tables of the manoeuvres: what changes a state, and that nothing else does.

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "algo/behavior/lane_change.hpp"
#include "algo/behavior/required_change.hpp"
#include "algo/behavior/zone_claim.hpp"

namespace s4tp::behavior {
namespace {

bool bit(int bits, int index) {
  return (bits >> index & 1) != 0;
}

template <class Situation>
std::vector<Situation> all();

template <>
std::vector<LaneChangeSituation> all() {
  std::vector<LaneChangeSituation> list;
  for (int b = 0; b < 64; ++b)
    list.push_back({bit(b, 0), bit(b, 1), bit(b, 2), bit(b, 3), bit(b, 4), bit(b, 5)});
  return list;
}

template <>
std::vector<RequiredChangeSituation> all() {
  std::vector<RequiredChangeSituation> list;
  for (int b = 0; b < 8; ++b) list.push_back({bit(b, 0), bit(b, 1), bit(b, 2)});
  return list;
}

template <>
std::vector<ZoneClaimSituation> all() {
  std::vector<ZoneClaimSituation> list;
  for (int b = 0; b < 16; ++b) list.push_back({bit(b, 0), bit(b, 1), bit(b, 2), bit(b, 3)});
  return list;
}

/// The rows that are the first to apply in some situation.
template <class State, class Situation, int kRows>
std::set<int> reached(const Transition<State, Situation> (&table)[kRows]) {
  std::set<int> rows;
  for (const Situation& situation : all<Situation>()) {
    for (int from = 0; from <= 4; ++from) {
      for (int i = 0; i < kRows; ++i) {
        if (static_cast<int>(table[i].from) != from || !table[i].condition(situation)) continue;
        rows.insert(i);
        EXPECT_EQ(next_state(table, table[i].from, situation), table[i].to);
        break;
      }
    }
  }
  return rows;
}

// BEHAV-002 BEHAV-003: there is a situation for each row in which it, and none before it, applies.
TEST(BehaviorTables, EachRowIsReached) {
  EXPECT_EQ(reached(kLaneChangeTable).size(), std::size_t{kLaneChangeRows});
  EXPECT_EQ(reached(kRequiredChangeTable).size(), std::size_t{kRequiredChangeRows});
  EXPECT_EQ(reached(kZoneClaimTable).size(), std::size_t{kZoneClaimRows});
}

// BEHAV-001: what is not in a row leaves the state: a plan in our lane keeps, nothing finishes but by coming over, only a
// settled change is over, and nothing ahead is nothing to claim.
TEST(BehaviorTables, ElseTheStateStays) {
  LaneChangeSituation lane;
  lane.goes_on = lane.over_line = lane.over_half = lane.inside = lane.settled = true;
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kKeep, lane), LaneChange::kKeep);
  lane = {};
  lane.leads_over = lane.goes_on = true;
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kPrepare, lane), LaneChange::kPrepare);
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kCrossing, lane), LaneChange::kCrossing);
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kFinish, {}), LaneChange::kFinish);
  lane = {};
  lane.inside = true;
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kSettle, lane), LaneChange::kSettle);
  lane.inside = false;
  lane.settled = true;
  EXPECT_EQ(next_state(kLaneChangeTable, LaneChange::kSettle, lane), LaneChange::kSettle);
  EXPECT_EQ(next_state(kZoneClaimTable, ZoneClaim::kConsidered, {}), ZoneClaim::kConsidered);
  EXPECT_EQ(next_state(kRequiredChangeTable, RequiredChange::kNone, {}), RequiredChange::kNone);
}

// BEHAV-003: whatever else holds, a group that lies ahead is committed to exactly when the fail-safe passes it.
TEST(BehaviorTables, CommittedIsWhatTheFailSafePasses) {
  for (int from = 0; from <= 4; ++from) {
    for (const ZoneClaimSituation& situation : all<ZoneClaimSituation>()) {
      if (situation.passed) continue;
      const ZoneClaim next = next_state(kZoneClaimTable, static_cast<ZoneClaim>(from), situation);
      EXPECT_EQ(next == ZoneClaim::kCommitted, situation.passes) << from;
    }
  }
}

}  // namespace
}  // namespace s4tp::behavior
