// Gaps in the lane beside: which one takes us, which one we can be in, and how soon.
// Our car: 5 m, rear axle 4 m behind the front and 1 m before the rear bumper. At 10 m/s all of them, we stop
// with 0.8 * 6 m/s^2 after 0.35 s within 3.5 + 10.42 = 13.92 m, the one in front with 8 m/s^2 within 6.25 m,
// the one behind with 5 m/s^2 after 1 s within 20 m: a change keeps 1 + 7.67 m to the one and 1 + 6.08 m to
// the other, and 0.2 m more. Our rear axle is at most 2.5 + 8.87 + 4 = 15.37 m behind the one's centre, and
// at least 2.5 + 7.28 + 1 = 10.78 m ahead of the other's. So 26.15 m between centres is the least.

#include "algo/planner/lane_gap.hpp"

#include <gtest/gtest.h>

namespace s4tp::planner {
namespace {

constexpr float kSpeedMps = 10.0F;

/// Centres at the horizon's end of vehicles of 5 m, in the lane.
LaneVehicles column(std::initializer_list<float> centres_m) {
  LaneVehicles vehicles;
  for (const float s_m : centres_m) (void)vehicles.push({s_m, 5.0F, kSpeedMps, true});
  put_in_order(vehicles);
  return vehicles;
}

GapSeeker at(float s_m) {
  GapSeeker us;
  us.s_m = s_m;
  us.speed_mps = kSpeedMps;
  us.limit_mps = 14.0F;
  return us;
}

// GAP-001 Three cars at 52, 80 and 97.5 m: 17.5 m between the first two take nobody, 28 m do.
TEST(LaneGap, TheForemostThatTakesUs) {
  const LaneVehicles lane = column({52.0F, 97.5F, 80.0F});
  EXPECT_FALSE(gap_between(&lane[0], &lane[1], 14.0F, Parameters{}).found);
  // At 34 + 30 m we are beside it already. In front of them all would be 44 m to gain by 4 m/s at most: over
  // 8 s.
  const LaneGap gap = find_lane_gap(lane, at(34.0F), Parameters{});
  ASSERT_TRUE(gap.found);
  EXPECT_NEAR(gap.front_s_m, 80.0F - 15.37F, 0.01F);
  EXPECT_NEAR(gap.rear_s_m, 52.0F + 10.78F, 0.01F);
  EXPECT_EQ(gap.speed_mps, kSpeedMps);
  // At 70 + 30 m, 8.3 m at 1.6 and 2 m/s^2 gain the place in front: sqrt(2 * 8.3 * 0.889) * 1.125 = 4.3 s.
  EXPECT_FALSE(find_lane_gap(lane, at(70.0F), Parameters{}).bounded_ahead);
}

// GAP-004 A column 26.5 m apart now: the second is 0.3 m/s faster, which would cost it 0.9 m of the 26.15 m
// needed by the horizon's end; but it keeps its distance. One who is 1 m/s faster comes nearer.
TEST(LaneGap, AColumnKeepsItsDistances) {
  for (const float faster_mps : {0.3F, 1.0F}) {
    LaneVehicles vehicles;
    (void)vehicles.push({80.0F, 5.0F, kSpeedMps, true});
    (void)vehicles.push({53.5F + 3.0F * faster_mps, 5.0F, kSpeedMps + faster_mps, true});
    put_in_order(vehicles);
    EXPECT_EQ(gap_between(&vehicles[0], &vehicles[1], 14.0F, Parameters{}).found, faster_mps < 0.5F);
    EXPECT_NEAR(vehicles[1].s_m, faster_mps > 0.5F ? 56.5F : 53.5F, 0.001F);
  }
}

// GAP-001 A free lane needs no gap.
TEST(LaneGap, NoneInAFreeLane) {
  EXPECT_FALSE(find_lane_gap(LaneVehicles{}, at(34.0F), Parameters{}).found);
}

// Beside a place 11.37 m behind us that is as fast as we are: braking with 2 m/s^2 to 4.5 m/s less, and
// speeding up again with 1.6: 2.25 + 2.81 s. From inside at 4 m/s too much: 4 / 2 s. In it at its speed: at
// once.
TEST(LaneGap, TimeToMeet) {
  const LaneGap gap = find_lane_gap(column({52.0F, 97.5F, 80.0F}), at(34.0F), Parameters{});
  EXPECT_NEAR(time_to_meet_s(gap, 3.0F, 46.0F, 10.0F, 14.0F, Parameters{}), 5.06F, 0.02F);
  EXPECT_NEAR(time_to_meet_s(gap, 0.0F, 60.3F, 14.0F, 14.0F, Parameters{}), 2.0F, 0.01F);
  EXPECT_EQ(time_to_meet_s(gap, 0.0F, 64.0F, 10.0F, 14.0F, Parameters{}), 0.0F);
}

// GAP-002 Beside the gap at 34 m already, our own leader must be 2.5 m away at least.
TEST(LaneGap, NotThroughOurLeader) {
  const LaneVehicles lane = column({52.0F, 97.5F, 80.0F});
  GapSeeker us = at(34.0F);
  us.has_leader = true;
  us.leader_mps = 5.0F;
  us.leader_s_m = 37.0F;
  EXPECT_TRUE(find_lane_gap(lane, us, Parameters{}).found);
  us.leader_s_m = 36.0F;
  EXPECT_FALSE(find_lane_gap(lane, us, Parameters{}).found);
}

// GAP-003 From 34 m and 10 m/s we come to rest within 100 / 5 = 20 m: by 54 m.
TEST(LaneGap, BeforeOurLaneEnds) {
  const LaneVehicles lane = column({52.0F, 97.5F, 80.0F});
  GapSeeker us = at(34.0F);
  us.change_due = true;
  us.end_s_m = 55.0F;
  EXPECT_TRUE(find_lane_gap(lane, us, Parameters{}).found);
  us.end_s_m = 53.0F;
  EXPECT_FALSE(find_lane_gap(lane, us, Parameters{}).found);
}

// GAP-003 Behind one at 5 m/s, at 40 m, we come to rest within 5 m, but a change takes 15 m: by 55 m.
TEST(LaneGap, BeforeThereIsNoRoomToChange) {
  LaneVehicles lane;
  (void)lane.push({80.0F, 5.0F, 5.0F, true});
  GapSeeker us = at(40.0F);
  us.speed_mps = 5.0F;
  us.change_due = true;
  us.end_s_m = 56.0F;
  EXPECT_TRUE(find_lane_gap(lane, us, Parameters{}).found);
  us.end_s_m = 54.0F;
  EXPECT_FALSE(find_lane_gap(lane, us, Parameters{}).found);
}

}  // namespace
}  // namespace s4tp::planner
