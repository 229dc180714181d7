// Who may go first where our way crosses another, as the terminal condition asks it.

#include "algo/safety/right_of_way.hpp"

#include <gtest/gtest.h>

#include "algo/core/math.hpp"
#include "tests/support/crossing.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

// TERM-013 The same drive, the other 56 m away: there after 56 / 15.28 = 3.7 s, 0.8 s after we have left. Too
// little, but not for one who has stood 9 s; 47 m (3.1 s) is too little for him as well.
TEST(RightOfWay, WhoHasWaitedTakesASmallerGap) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 56.0F, 15.0F);
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.waited_s = 9.0F;
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 47.0F, 15.0F);
  near.scene.waited_s = 9.0F;
  EXPECT_FALSE(near.safe(80.0F, 8.0F, 0.0F));
}

// TERM-013 6.5 m before the zone at 8 m/s, stopping takes 4.9 m/s^2, and we leave after 1.9 s. The other, 38
// m away, comes after 2.5 s: not enough to begin with, but enough to go through with. 26 m (1.7 s) are not.
TEST(RightOfWay, ACrossingUnderWayIsFinished) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 38.0F, 15.0F);
  EXPECT_TRUE(crossing.safe(88.0F, 8.0F, 0.0F));
  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 26.0F, 15.0F);
  EXPECT_FALSE(near.safe(88.0F, 8.0F, 0.0F));
}

// TERM-015 From 93 with 3 m/s^2 we are in the zone after 1 s and out after 2.5 s. The other stands 9 m before
// it: starting now it is there after 3 s. That is enough once it has stood for 2 s with nobody to wait for;
// so with one who comes up behind it. Half a metre before the zone (0.7 s, and 0.5 s to start) it goes first,
// when we come from 91 (1.6 s); after 4 s, too (0.7 + 4 / 4 s).
TEST(RightOfWay, WhoStandsForNothingDoesNotUseHisRightOfWay) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 9.0F, 0.0F).idle_ms = 1900;
  EXPECT_FALSE(crossing.safe(93.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 2000;
  EXPECT_TRUE(crossing.safe(93.0F, 0.0F, 3.0F));
  (void)crossing.other(96.0F - 16.0F, 3.0F);
  EXPECT_TRUE(crossing.safe(93.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 0;
  EXPECT_FALSE(crossing.safe(93.0F, 0.0F, 3.0F));

  Crossing near(Priority::kFirstYields);
  near.other(96.0F - 0.5F, 0.0F).idle_ms = 2000;
  EXPECT_FALSE(near.safe(91.0F, 0.0F, 3.0F));
  near.scene.agents[0].idle_ms = 4000;
  EXPECT_TRUE(near.safe(91.0F, 0.0F, 3.0F));
}

// TERM-022 One stands 0.2 m inside the zone, its front 1.3 m from our centre line: 0.4 m beside our box. From
// 91 with 3 m/s^2 we are there after 1.6 s: it goes first while it has stood for 2.5 s, not after 8 s (8 / 4
// = 2 s).
TEST(RightOfWay, WhoStandsInTheZoneForLongIsPassed) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.2F, 0.0F).idle_ms = 2500;
  EXPECT_FALSE(crossing.safe(91.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 8000;
  EXPECT_TRUE(crossing.safe(91.0F, 0.0F, 3.0F));
}

// TERM-015 From 93 with 3 m/s^2 we are out of the zone after 2.5 s. One who has stood for a second 7.5 m
// before it could be there after 2.7 s: without the usual margin, for he stands. 3.6 m before it (1.9 s) he
// goes first. So does who stood for less than a second.
TEST(RightOfWay, WhoStandsNeedsTimeToStart) {
  const auto crossing = [](float way_m, int samples_standing) {
    Crossing road(Priority::kFirstYields);
    Agent& other = road.other(96.0F - way_m, 0.0F);
    other.history.valid = (1U << kHistorySamples) - 1U;
    for (int i = 0; i < kHistorySamples - samples_standing; ++i) other.history.samples[i].speed_mps = 1.0F;
    return road.safe(93.0F, 0.0F, 3.0F);
  };
  EXPECT_TRUE(crossing(7.5F, kHistorySamples));
  EXPECT_FALSE(crossing(7.5F, kHistorySamples - 1));
  EXPECT_FALSE(crossing(3.6F, kHistorySamples));
}

// TERM-015 Four where the right goes before the left: the one on our right stands 3.3 m before the zone, and
// could be there after 1.8 s, we after 1.6 s. He waits for his right, who waits for nobody that moves: one
// has to begin.
TEST(RightOfWay, AStandOffIsEnded) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 3.3F, 0.0F);
  EXPECT_FALSE(crossing.safe(91.0F, 0.0F, 3.0F));
  crossing.scene.agents[0].idle_ms = 2500;
  EXPECT_TRUE(crossing.safe(91.0F, 0.0F, 3.0F));
}

// TERM-016 At 3 m/s inside one zone, 4.5 m before the next (there after 1.5 s, out after 3.5 s). The other is
// 9 m before that, at 2 m/s there after sqrt(10) - 1 = 2.2 s at the earliest: we do not stop in the first
// zone for it. Outside of any zone we would; and for one who comes at 13 m/s, too.
TEST(RightOfWay, NobodyStopsInOneZoneForTheNext) {
  const auto crossing = [](bool inside_one, float way_m, float speed_mps) {
    Crossing road(Priority::kFirstYields);
    ConflictZone next = road.zone();
    next.entry_s_m = 106.0F;
    next.exit_s_m = 112.0F;
    next.stop_s_m = 95.0F;
    if (!inside_one) road.scene.ego_paths[0].zones.clear();
    (void)road.scene.ego_paths[0].zones.push(next);
    road.other(96.0F - way_m, speed_mps);
    return road.safe(100.0F, 3.0F, 0.0F);
  };
  EXPECT_TRUE(crossing(true, 9.0F, 2.0F));
  EXPECT_FALSE(crossing(false, 9.0F, 2.0F));
  EXPECT_FALSE(crossing(true, 40.0F, 13.0F));
}

// TERM-021 From the line at 91 with 2 m/s^2 we have left the zone after 3.42 s; who has waited 9 s wants 0.7
// s more. The other at 9 m/s, 40 m before it, could be there after 3.26 s, but going on as it does comes
// after 4.44 s; from 35 m after 3.89 s. One of 13.9 m/s 45 m away could not stop with 2 m/s^2 (48 m).
TEST(RightOfWay, WhoHasWaitedGoesByWhatOthersDo) {
  const auto crossing = [](float way_m, float speed_mps, float waited_s) {
    Crossing road(Priority::kFirstYields);
    road.other(96.0F - way_m, speed_mps);
    road.scene.waited_s = waited_s;
    return road.safe(91.0F, 0.0F, 2.0F);
  };
  EXPECT_TRUE(crossing(40.0F, 9.0F, 9.0F));
  EXPECT_FALSE(crossing(40.0F, 9.0F, 1.0F));
  EXPECT_FALSE(crossing(35.0F, 9.0F, 9.0F));
  EXPECT_FALSE(crossing(45.0F, 13.9F, 9.0F));
}

// TERM-021 The same start. At 6 m/s and braking with 2 m/s^2, he is expected to set off after 0.5 s with 1.5
// m/s^2: 33 m take (sqrt(36 + 99) - 6) / 1.5 + 0.5 = 4.25 s, 24 m 3.43 s: he may be stopping for us or not.
TEST(RightOfWay, WhoBrakesIsExpectedToSetOff) {
  for (const float way_m : {33.0F, 24.0F}) {
    Crossing road(Priority::kFirstYields);
    road.other(96.0F - way_m, 6.0F).track.acceleration_mps2 = -2.0F;
    road.scene.waited_s = 9.0F;
    EXPECT_EQ(road.safe(91.0F, 0.0F, 2.0F), way_m > 30.0F) << way_m;
  }
}

// TERM-021 One 30 m away at 9 m/s whose way through the zone has a probability of 5 % is not waited for by
// who has waited; with 20 % it is.
TEST(RightOfWay, UnlikelyWaysAreNotExpected) {
  for (const float probability : {0.05F, 0.2F}) {
    Crossing road(Priority::kFirstYields);
    road.other(96.0F - 30.0F, 9.0F).path_probability[0] = probability;
    road.scene.waited_s = 9.0F;
    EXPECT_EQ(road.safe(91.0F, 0.0F, 2.0F), probability < 0.1F) << probability;
  }
}

// TERM-016 Two zones from 96 to 104 and from 106 to 112 leave no place to wait between them: a crossing begun
// before the first is under way to 112. 4 m before it (to stop with 1.4 * 2.5 = 3.5 m/s^2 takes them
// from 5.29 m/s) it is not yet at 5.2 m/s, for who stops at the line a little late has begun nothing; at 5.4
// m/s it is. Between two zones 6 m apart one can wait: then it ends at 104.
TEST(RightOfWay, ACrossingIsUnderWayToItsLastExit) {
  Crossing road(Priority::kFirstYields);
  ConflictZone next = road.zone();
  next.entry_s_m = 106.0F;
  next.exit_s_m = 112.0F;
  (void)road.scene.ego_paths[0].zones.push(next);
  EgoPath& path = road.scene.ego_paths[0];
  EXPECT_FLOAT_EQ(under_way_until_s_m(path, 92.0F, 5.2F, road.parameters), 92.0F);
  EXPECT_FLOAT_EQ(under_way_until_s_m(path, 92.0F, 5.4F, road.parameters), 112.0F);
  EXPECT_FLOAT_EQ(under_way_until_s_m(path, 105.0F, 1.0F, road.parameters), 105.0F);
  path.zones[1].entry_s_m = 110.0F;
  EXPECT_FLOAT_EQ(under_way_until_s_m(path, 100.0F, 1.0F, road.parameters), 104.0F);
}

// TERM-016 At 3 m/s inside one zone, 4.5 m before the next (there after 1.5 s). The other, 9 m before that at
// 2 m/s (2.2 s), is trusted while it goes on; not when it sets off with 2 m/s^2 as we did: then a second is
// asked for, and from 12 m (2.6 s) there is one.
TEST(RightOfWay, WhoSetsOffWhenWeDoMayNotSeeUs) {
  const auto crossing = [](float way_m, float acceleration_mps2) {
    Crossing road(Priority::kFirstYields);
    ConflictZone next = road.zone();
    next.entry_s_m = 106.0F;
    next.exit_s_m = 112.0F;
    next.stop_s_m = 95.0F;
    (void)road.scene.ego_paths[0].zones.push(next);
    road.other(96.0F - way_m, 2.0F).track.acceleration_mps2 = acceleration_mps2;
    return road.safe(100.0F, 3.0F, 0.0F);
  };
  EXPECT_TRUE(crossing(9.0F, 0.0F));
  EXPECT_FALSE(crossing(9.0F, 2.0F));
  EXPECT_TRUE(crossing(12.0F, 2.0F));
}

// TERM-015 One comes at 9 m/s, 27 m before the zone, behind one who has stood for a second 5 m before it: he
// cannot be there before that one, who is expected after 0.5 + sqrt(10 / 1.5) = 3.1 s, and he a second later.
// From 93 with 3 m/s^2 we are in the zone after 1 s and out after 2.5 s. Alone he is there after 3 s: too
// soon.
TEST(RightOfWay, NobodyPassesTheOneInFront) {
  for (const bool queue : {true, false}) {
    Crossing road(Priority::kFirstYields);
    road.scene.waited_s = 9.0F;
    road.other(96.0F - 27.0F, 9.0F);
    if (queue) {
      Agent& head = road.other(96.0F - 5.0F, 0.0F);
      head.history.valid = (1U << kHistorySamples) - 1U;
    }
    EXPECT_EQ(road.safe(93.0F, 0.0F, 3.0F), queue);
  }
}

// TERM-016 0.1 m before the zone at 2 m/s nobody can stop any more (20 m/s^2): who could be trusted by one
// who still might stop is trusted now as well. The other, 12 m away at 6 m/s, comes at its present speed
// after 2 s, while we are there; but he brakes with 3 m/s^2, and is expected only after 3 s.
TEST(RightOfWay, BoundToGoIsNoStricterThanUnderWay) {
  Crossing road(Priority::kFirstYields);
  Agent& other = road.other(96.0F - 12.0F, 6.0F);
  other.track.acceleration_mps2 = -3.0F;
  other.path_probability[0] = 0.05F;  // he is likely to turn off
  EXPECT_TRUE(road.safe(94.4F, 2.0F, 1.0F));
}

// TERM-004 Who owes us the way and needs less than 4 m/s^2 (10 m/s: 12.5 m) is trusted; who needs more is
// not.
TEST(RightOfWay, OthersAreTrustedWhileTheyCanStop) {
  Crossing can(Priority::kFirstHasPriority);
  can.other(96.0F - 13.5F, 10.0F);
  EXPECT_TRUE(can.safe(78.0F, 10.0F, 0.0F));
  Crossing cannot(Priority::kFirstHasPriority);
  cannot.other(96.0F - 11.5F, 10.0F);
  EXPECT_FALSE(cannot.safe(78.0F, 10.0F, 0.0F));
}

// TERM-004 First come: at equal speeds and the other twice as far we go; the other way round we do not.
TEST(RightOfWay, FirstComeFirstServed) {
  Crossing first(Priority::kFirstCome);
  first.other(96.0F - 60.0F, 8.0F);
  EXPECT_TRUE(first.safe(80.0F, 8.0F, 0.0F));
  Crossing second(Priority::kFirstCome);
  second.other(96.0F - 8.0F, 8.0F);
  EXPECT_FALSE(second.safe(80.0F, 8.0F, 0.0F));
}

// TERM-005 The other leaves the zone in 4 m at 10 m/s; we come in 1.8 s: nothing to wait for.
TEST(RightOfWay, WhoIsGoneBeforeWeComeDoesNotCount) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(100.0F, 10.0F);
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.agents[0].track.speed_mps = 0.5F;  // it crawls: in 4 m it is not gone
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
}

// TERM-003 Who comes after us into the same lane may meet us on the way in: he must not be at the zone's exit
// 1 s after we have left it. From s = 80 at 8 m/s we leave after 2.8 s; he, at 13 m/s gaining 2 m/s^2 up
// to 15.28, needs 3.6 s for the 54 m to the entry and 4.1 s for the 62 m to the exit: enough when he merges,
// too near when he crosses.
TEST(RightOfWay, AMergeIsLeftBehind) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 54.0F, 13.0F);
  EXPECT_FALSE(crossing.safe(80.0F, 8.0F, 0.0F));
  crossing.scene.ego_paths[0].zones[0].merging = true;
  EXPECT_TRUE(crossing.safe(80.0F, 8.0F, 0.0F));
}

// TERM-011 10 m before the entry at the top speed of 1.1 * 13.89 = 15.28 m/s: 0.654 s. From rest with 2
// m/s^2: sqrt(2 * 10 / 2) = 3.16 s. Inside 0; past it or elsewhere 1000.
TEST(EarliestArrival, FreeToAccelerate) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(86.0F, 15.279F);
  crossing.other(86.0F, 0.0F);
  crossing.other(100.0F, 5.0F);
  crossing.other(105.0F, 5.0F);
  add_vehicle(crossing.scene, crossing.map, crossing.ours, 50.0F, 10.0F);
  const float expected[] = {0.654F, 3.162F, 0.0F, 1000.0F, 1000.0F};
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(earliest_arrival_s(crossing.scene, i, crossing.zone(), crossing.parameters), expected[i],
                0.01F)
        << i;
}

// TERM-011 Who brakes with 4 m/s^2 goes on for half a second: from 10 m/s to 8 in 4.5 m, and then 15.5 m from
// there in (sqrt(64 + 62) - 8) / 2 = 1.61 s.
TEST(EarliestArrival, BrakesAreNotDriveAtOnce) {
  Crossing crossing(Priority::kFirstYields);
  crossing.other(96.0F - 20.0F, 10.0F).track.acceleration_mps2 = -4.0F;
  EXPECT_NEAR(earliest_arrival_s(crossing.scene, 0, crossing.zone(), crossing.parameters), 2.11F, 0.01F);
}

}  // namespace
}  // namespace s4tp
