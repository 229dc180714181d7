// GUARD-013: whom the guard goes on counting with after a lane change is made, or given up.
//
// Everybody drives on a straight road of two lanes. Those behind answer 0.5 s after we are over the line and brake with 5 m/s^2;
// 0.5 m stay between the bumpers.

#include <gtest/gtest.h>

#include "algo/safety/guard.hpp"
#include "tests/support/lane_change_road.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr float kOwnMps = 10.0F;
constexpr float kItsMps = 15.0F;

/// A change to the left is in force; a second later we are `beside_m` left of the centre of our lane, which is lane `own_lane`, and
/// one is behind us in the left lane, `gap_m` from bumper to bumper and 5 m/s faster.
struct AfterAChange {
  Guard guard;
  Parameters parameters;
  bool sets_out = true;
  std::uint32_t later_ms = 1000;

  /// Of a plan that holds `acceleration_mps2` and ends `to_m` left of that centre.
  [[nodiscard]] Verdict judge(LaneIndex own_lane, float beside_m, float to_m, float gap_m,
                              float acceleration_mps2) {
    LaneChangeRoad before;
    const TrajectoryPoint set_out = state_on(before.map, before.scene.ego_paths[0].path, 88.5F, kOwnMps);
    put_ego(before.scene, set_out);
    guard.look(before.scene, set_out, 0.0F, parameters);
    if (sets_out) guard.commit(1, guard.judge(1, across(set_out, 0.0F, kLaneWidthM)));

    LaneMap map = straight_road(2, 400.0F);
    scene::Scene scene;
    add_ego_path(scene, map, path_of(map, {own_lane}));
    TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 98.5F, kOwnMps);
    start.rear_axle.y_m += beside_m;
    put_ego(scene, start);
    scene.time_ms = before.scene.time_ms + later_ms;
    add_vehicle(scene, map, path_of(map, {1}), 100.0F - 5.0F - gap_m, kItsMps);
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(0, across(start, acceleration_mps2, to_m - beside_m));
  }
};

// GUARD-013 Over the line just now, 1.4 m short of the new lane's centre, with one 7 m behind: until it is as slow as we are, after
// 1.5 s, it comes 5 m nearer while we go on; while we brake with 4 m/s^2 it comes 10 m nearer.
TEST(GuardSettle, WhoIsNewInALaneDoesNotBrakeBeforeOneBehind) {
  EXPECT_EQ(AfterAChange().judge(1, -1.4F, 0.0F, 7.0F, 0.0F).cause, Cause::kNone);
  const Verdict verdict = AfterAChange().judge(1, -1.4F, 0.0F, 7.0F, -4.0F);
  EXPECT_EQ(verdict.cause, Cause::kFollower);
  EXPECT_EQ(verdict.agent, 0);
  EXPECT_EQ(AfterAChange().judge(1, -1.4F, 0.0F, 4.0F, 0.0F).cause, Cause::kFollower);
}

// GUARD-013 The fail-safe of such a plan leaves it that room, too: not at once 6 m/s^2, but after two seconds, or more gently.
TEST(GuardSettle, ItsFailSafeLeavesThatRoom) {
  const Verdict verdict = AfterAChange().judge(1, -1.4F, 0.0F, 7.0F, 0.0F);
  ASSERT_TRUE(verdict.safe());
  EXPECT_TRUE(verdict.fail_safe.branch_s >= 2.0F || verdict.fail_safe.braking_mps2 < 4.0F);
}

// GUARD-013 Two seconds after it was last in force whoever is behind keeps its own distance; so it does where there was no change.
TEST(GuardSettle, AfterAWhileWhoIsBehindLooksAhead) {
  for (const bool sets_out : {true, false}) {
    AfterAChange change;
    change.sets_out = sets_out;
    change.later_ms = sets_out ? 2100 : 1000;
    EXPECT_EQ(change.judge(1, -1.4F, 0.0F, 7.0F, -4.0F).cause, Cause::kNone) << sets_out;
  }
}

// GUARD-013 Given up 1 m out of our lane's middle, our box 0.3 m over the line: whoever comes there from behind may not be braked
// for while we stay so. Back 0.3 m, after 0.9 s, it is our lane alone: the other has come 4.1 m nearer by then.
TEST(GuardSettle, WhoGoesBackLeavesTheOtherLaneFirst) {
  EXPECT_EQ(AfterAChange().judge(0, 1.0F, 1.0F, 7.0F, -4.0F).cause, Cause::kFollower);
  EXPECT_EQ(AfterAChange().judge(0, 1.0F, 0.0F, 7.0F, 0.0F).cause, Cause::kNone);
  EXPECT_EQ(AfterAChange().judge(0, 1.0F, 0.0F, 3.0F, 0.0F).cause, Cause::kFollower);
}

}  // namespace
}  // namespace s4tp::safety
