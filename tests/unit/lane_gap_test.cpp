// Gaps in the lane beside: which one takes us, which one we can be in, and how soon.
// Our car: 5 m, rear axle 4 m behind the front and 1 m before the rear bumper. At 10 m/s all of them, a
// change keeps 1 + 100/10 - 100/16 = 4.75 m to the one in front and 1 + 0.2 * 10 = 3 m to the one behind,
// and 0.2 m more: our rear axle is at most 2.5 + 4.95 + 4 = 11.45 m behind the one's centre, and at least 2.5
// + 3.2 + 1 = 6.7 m ahead of the other's. So 18.15 m between centres is the least.

#include "algo/planner/lane_gap.hpp"

#include <gtest/gtest.h>

namespace s4tp {
namespace {

constexpr float kSpeedMps = 10.0F;

/// Centres at the horizon's end of vehicles of 5 m, in the lane.
LaneVehicles column(std::initializer_list<float> centres_m) {
  LaneVehicles vehicles;
  for (const float s_m : centres_m) (void)vehicles.push({s_m, 5.0F, kSpeedMps, true});
  put_in_order(vehicles, Parameters{});
  return vehicles;
}

GapSeeker at(float s_m) {
  GapSeeker us;
  us.s_m = s_m;
  us.speed_mps = kSpeedMps;
  us.limit_mps = 14.0F;
  return us;
}

// GAP-001 Three cars at 55, 80 and 97.5 m: 17.5 m between the first two take nobody, 25 m do.
TEST(LaneGap, TheForemostThatTakesUs) {
  const LaneVehicles lane = column({55.0F, 97.5F, 80.0F});
  EXPECT_FALSE(lane[0].tight);
  EXPECT_TRUE(lane[1].tight);
  EXPECT_FALSE(lane[2].tight);
  // At 36 + 30 m we are beside it already. In front of them all would be 38 m to gain by 4 m/s at most: over
  // 8 s.
  const LaneGap gap = find_lane_gap(lane, at(36.0F), Parameters{});
  ASSERT_TRUE(gap.found);
  EXPECT_NEAR(gap.front_s_m, 80.0F - 11.45F, 0.01F);
  EXPECT_NEAR(gap.rear_s_m, 55.0F + 6.7F, 0.01F);
  EXPECT_EQ(gap.speed_mps, kSpeedMps);
  // At 70 + 30 m, 4.2 m at 1.6 and 2 m/s^2 gain the place in front: sqrt(2 * 4.2 * 0.889) * 1.125 = 3.1 s.
  EXPECT_FALSE(find_lane_gap(lane, at(70.0F), Parameters{}).bounded_ahead);
}

// GAP-004 A column 18.5 m apart now: the second is 0.3 m/s faster, which would cost it 0.9 m of the 18.15 m
// needed by the horizon's end; but he keeps his distance. One who is 1 m/s faster comes nearer.
TEST(LaneGap, AColumnKeepsItsDistances) {
  for (const float faster_mps : {0.3F, 1.0F}) {
    LaneVehicles vehicles;
    (void)vehicles.push({80.0F, 5.0F, kSpeedMps, true});
    (void)vehicles.push({61.5F + 3.0F * faster_mps, 5.0F, kSpeedMps + faster_mps, true});
    put_in_order(vehicles, Parameters{});
    EXPECT_EQ(vehicles[1].tight, faster_mps > 0.5F);
    EXPECT_NEAR(vehicles[1].s_m, faster_mps > 0.5F ? 64.5F : 61.5F, 0.001F);
  }
}

// GAP-001 A free lane needs no gap.
TEST(LaneGap, NoneInAFreeLane) {
  EXPECT_FALSE(find_lane_gap(LaneVehicles{}, at(36.0F), Parameters{}).found);
}

// Beside a place 7.45 m behind us that is as fast as we are: braking with 2 m/s^2 to 3.64 m/s less, and
// speeding up again with 1.6: 1.82 + 2.28 s. From inside at 4 m/s too much: 4 / 2 s. In it at its speed: at
// once.
TEST(LaneGap, TimeToMeet) {
  const LaneGap gap = find_lane_gap(column({55.0F, 97.5F, 80.0F}), at(36.0F), Parameters{});
  EXPECT_NEAR(time_to_meet_s(gap, 3.0F, 46.0F, 10.0F, 14.0F, Parameters{}), 4.1F, 0.02F);
  EXPECT_NEAR(time_to_meet_s(gap, 0.0F, 64.3F, 14.0F, 14.0F, Parameters{}), 2.0F, 0.01F);
  EXPECT_EQ(time_to_meet_s(gap, 0.0F, 66.0F, 10.0F, 14.0F, Parameters{}), 0.0F);
}

// GAP-002 Beside the gap at 36 m already, our own leader must be 2.5 m away at least.
TEST(LaneGap, NotThroughOurLeader) {
  const LaneVehicles lane = column({55.0F, 97.5F, 80.0F});
  GapSeeker us = at(36.0F);
  us.has_leader = true;
  us.leader_mps = 5.0F;
  us.leader_s_m = 39.0F;
  EXPECT_TRUE(find_lane_gap(lane, us, Parameters{}).found);
  us.leader_s_m = 38.0F;
  EXPECT_FALSE(find_lane_gap(lane, us, Parameters{}).found);
}

// GAP-003 From 36 m and 10 m/s we come to rest within 100 / 5 = 20 m: by 56 m.
TEST(LaneGap, BeforeOurLaneEnds) {
  const LaneVehicles lane = column({55.0F, 97.5F, 80.0F});
  GapSeeker us = at(36.0F);
  us.change_due = true;
  us.end_s_m = 57.0F;
  EXPECT_TRUE(find_lane_gap(lane, us, Parameters{}).found);
  us.end_s_m = 55.0F;
  EXPECT_FALSE(find_lane_gap(lane, us, Parameters{}).found);
}

}  // namespace
}  // namespace s4tp
