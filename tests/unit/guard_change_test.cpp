// Where the guard lets a plan change lanes.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2, which builds up in 0.15 s (guard_test.cpp). Places are those of the box centre, 2.5 m
// behind the front bumper.

#include <gtest/gtest.h>

#include "algo/safety/guard.hpp"
#include "tests/support/lane_change_road.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// A change from the right lane to the left one, over within 3 s; our box centre is at 100.
struct Change : LaneChangeRoad {
  scene::Agent& in_left_lane(float s_m, float speed_mps) {
    return add_vehicle(scene, map, path_of(map, {1}), s_m, speed_mps);
  }
  [[nodiscard]] Cause cause(float speed_mps, float acceleration_mps2, int path = 1) {
    return cause_across(speed_mps, acceleration_mps2, path, 0.0F, path == 1 ? kLaneWidthM : 0.0F);
  }
  /// Of a plan that comes from `from_m` to `to_m` left of the right lane's centre within 3 s.
  [[nodiscard]] Cause cause_across(float speed_mps, float acceleration_mps2, int path, float from_m,
                                   float to_m, float ahead_m = 0.0F) {
    TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 98.5F, speed_mps);
    start.rear_axle.y_m += from_m;
    TrajectoryPoint driven = start;
    driven.rear_axle = shift_ahead(start.rear_axle, ahead_m);
    put_ego(scene, driven);
    Guard guard;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(path, across(start, acceleration_mps2, to_m - from_m)).cause;
  }
};

// GUARD-009 One behind in the lane we come to, 5 m/s faster, 3 m behind our bumper: after 1 s it has come 5 m
// nearer. 40 m behind it has room to brake. In our own lane it is its own business.
TEST(Guard, AChangeLeavesTheFollowerRoomToBrake) {
  for (const float gap_m : {3.0F, 40.0F}) {
    Change change;
    change.in_left_lane(100.0F - 5.0F - gap_m, 15.0F);
    EXPECT_EQ(change.cause(10.0F, 0.0F), gap_m < 10.0F ? Cause::kFollower : Cause::kNone) << gap_m;
    EXPECT_EQ(change.cause(10.0F, 0.0F, 0), Cause::kNone);
  }
}

// GUARD-009 As fast as we are, it may gain 2 m/s^2 until we are over the line after 0.8 s, and for 0.5 s more: 1.7 m nearer and 2.6
// m/s faster, which takes 0.7 m to brake away. With the 0.5 m kept that is 2.9 m. 0.5 m on the way we are over 0.4 s sooner.
TEST(Guard, WhoIsBehindMayGainSpeedUntilWeAreOver) {
  for (const float gap_m : {4.0F, 2.0F}) {
    Change change;
    change.in_left_lane(100.0F - 5.0F - gap_m, 10.0F);
    EXPECT_EQ(change.cause(10.0F, 0.0F), gap_m < 3.0F ? Cause::kFollower : Cause::kNone) << gap_m;
    EXPECT_EQ(change.cause_across(10.0F, 0.0F, 1, 0.5F, kLaneWidthM), Cause::kNone) << gap_m;
  }
}

// GUARD-009 Our box 0.3 m over the line, at 15 m/s, when one is there 8 m behind at 25 m/s: it cannot brake for us however
// we stop, so it has come in against the law or out of nowhere. A plan that drives on leaves it as much room as can be and
// passes, one that brakes leaves it less. 0.3 m short of the line the change is not made.
TEST(Guard, BeforeOneThatCannotBrakeAnyMoreWeDriveOn) {
  Change change;
  change.in_left_lane(100.0F - 5.0F - 8.0F, 25.0F);
  EXPECT_EQ(change.cause_across(15.0F, 1.0F, 1, 1.0F, kLaneWidthM), Cause::kNone);
  EXPECT_EQ(change.cause_across(15.0F, -3.0F, 1, 1.0F, kLaneWidthM), Cause::kFollower);
  EXPECT_EQ(change.cause_across(15.0F, 1.0F, 1, 0.4F, kLaneWidthM), Cause::kFollower);
}

// GUARD-009 The same whether our centre is short of the line, 1.6 m from our lane's, or beyond.
TEST(Guard, AChangeHalfMadeLeavesTheFollowerItsRoom) {
  for (const float from_m : {1.4F, 1.8F, 2.4F, 3.0F}) {
    Change change;
    change.in_left_lane(100.0F - 5.0F - 8.0F, 25.0F);
    EXPECT_EQ(change.cause_across(15.0F, 1.0F, 1, from_m, kLaneWidthM), Cause::kNone) << from_m;
    EXPECT_EQ(change.cause_across(15.0F, -3.0F, 1, from_m, kLaneWidthM), Cause::kFollower) << from_m;
  }
}

// GUARD-009 One beside us, half a length back, leaves no room for a change at all.
TEST(Guard, NobodyChangesIntoOneBeside) {
  Change change;
  change.in_left_lane(97.5F, 10.0F);
  EXPECT_EQ(change.cause(10.0F, 0.0F), Cause::kFollower);
  EXPECT_EQ(change.cause(10.0F, 0.0F, 0), Cause::kNone);
}

// GUARD-009 GUARD-012 By a list 260 ms old nobody sets out for another lane, from rest neither: somebody may have come into sight
// there since. In our lane, and 0.5 m on the way already, we go on.
TEST(Guard, NobodySetsOutForALaneByAnOldList) {
  for (const std::uint16_t age_ms : {250, 260}) {
    Change change;
    change.scene.known.age_ms = age_ms;
    for (const float speed_mps : {0.0F, 10.0F})
      EXPECT_EQ(change.cause(speed_mps, 0.0F), age_ms > 250 ? Cause::kFollower : Cause::kNone);
    EXPECT_EQ(change.cause(10.0F, 0.0F, 0), Cause::kNone);
    for (scene::EgoPath& path : change.scene.ego_paths) path.frenet.d_m += 0.5F;
    EXPECT_EQ(change.cause_across(10.0F, 0.0F, 1, 0.5F, kLaneWidthM), Cause::kNone);
  }
}

// GUARD-009 A slow one ahead in the lane we come to is a leader like any other: 10 m/s need 3.5 + 9.1 + 0.5 =
// 13.1 m before one that stands.
TEST(Guard, AChangeStopsBehindTheLeaderThere) {
  for (const float gap_m : {14.0F, 10.0F}) {
    Change change;
    change.in_left_lane(100.0F + 5.0F + gap_m, 0.0F);
    EXPECT_EQ(change.cause(10.0F, 0.0F), gap_m > 12.0F ? Cause::kNone : Cause::kLeader) << gap_m;
  }
}

// GUARD-009 One that passes us in the lane we come to, its rear 3 m behind our front: after 0.5 s, braking with 8
// m/s^2, that is 99.5 + 5.5 = 105, our front at 102.5 + 4.5 = 107. Its rear 3 m ahead of our front it has gone by.
TEST(Guard, NobodyChangesIntoOneThatPasses) {
  for (const float ahead_m : {-3.0F, 3.0F}) {
    Change change;
    change.in_left_lane(102.5F + ahead_m + 2.5F, 13.0F);
    EXPECT_EQ(change.cause(9.0F, 0.0F), ahead_m > 0.0F ? Cause::kNone : Cause::kLeader) << ahead_m;
    EXPECT_EQ(change.cause(9.0F, 0.0F, 0), Cause::kNone);
  }
}

// GUARD-004 GUARD-009 A change begun at 10 m/s, which takes 12.6 m to stop, while one stands ahead in the lane we leave: our
// box is clear of it after 1.9 s, 19 m further; plans are looked at every 0.2 s, 2 m.
TEST(Guard, AChangeStopsBehindTheLeaderInTheLaneItLeaves) {
  for (const float gap_m : {16.0F, 10.0F}) {
    Change change;
    add_vehicle(change.scene, change.map, path_of(change.map, {0}), 100.0F + 5.0F + gap_m, 0.0F);
    EXPECT_EQ(change.cause(10.0F, 0.0F), gap_m > 12.0F ? Cause::kNone : Cause::kLeader) << gap_m;
  }
}

// GUARD-004 A change given up: 1.4 m left of our lane's centre our box reaches into the left lane, where one stands
// ahead. Rolling on like that it has to be stopped for, as if it were in our lane; coming back we are clear of it in 5 m.
TEST(Guard, WhoIsBetweenTwoLanesHasALeaderInEach) {
  const auto cause = [](float gap_m, float to_m) {
    Change change;
    change.in_left_lane(100.0F + 5.0F + gap_m, 0.0F);
    return change.cause_across(10.0F, 0.0F, 0, 1.4F, to_m);
  };
  EXPECT_EQ(cause(16.0F, 1.4F), Cause::kNone);
  EXPECT_EQ(cause(10.0F, 1.4F), Cause::kLeader);
  EXPECT_EQ(cause(10.0F, 0.0F), Cause::kNone);
}

// GUARD-004 Between two lanes at 1 m/s, which takes 0.43 m to stop, 0.9 m behind one that stands, of which 0.2 m are kept: enough, unless
// the vehicle is 0.5 m ahead of its plan.
TEST(Guard, WhoIsAheadOfItsPlanBetweenTwoLanesIsJudgedFromThere) {
  const auto cause = [](float ahead_m) {
    Change change;
    change.in_left_lane(100.0F + 5.0F + 0.9F, 0.0F);
    return change.cause_across(1.0F, 0.0F, 0, 1.4F, 1.4F, ahead_m);
  };
  EXPECT_EQ(cause(0.0F), Cause::kNone);
  EXPECT_EQ(cause(0.5F), Cause::kLeader);
}

// GUARD-004 Beside one that stands half in our lane, nearer than the 0.2 m kept: from rest we may leave it, and come no nearer.
TEST(Guard, WhoStandsTooNearBesideAnotherMayOnlyLeaveIt) {
  const auto cause = [](float to_m) {
    Change change;
    change.in_left_lane(103.0F, 0.0F);
    return change.cause_across(0.0F, 1.0F, 0, 1.4F, to_m);
  };
  EXPECT_EQ(cause(0.0F), Cause::kNone);
  EXPECT_EQ(cause(1.6F), Cause::kLeader);
}

// GUARD-004 One stands across our way, its front 0.5 m right of our lane's centre, and our way leads 0.7 m left of the centre past it:
// 0.3 m beside our box, and 0.4 m into it where we are on the centre yet. At 10 m/s, which takes 12.6 m to stop, we pass from the
// offset way; on the centre we may still stop from 16 m away, and from 10 m away not.
TEST(Guard, WhoIsNotYetOnItsWayPastAnotherStopsForIt) {
  const auto cause = [](float gap_m, float from_m) {
    Change change;
    change.scene.ego_paths[0].lateral_offset_m = 0.7F;
    scene::Agent& across =
        add_vehicle(change.scene, change.map, path_of(change.map, {0}), 103.4F + gap_m, 0.0F);
    across.track.centre.heading_rad = 0.5F * kPi;
    across.track.centre.y_m = -0.5F - 0.5F * across.track.length_m;
    return change.cause_across(10.0F, 0.0F, 0, from_m, from_m);
  };
  EXPECT_EQ(cause(10.0F, 0.7F), Cause::kNone);
  EXPECT_EQ(cause(16.0F, 0.0F), Cause::kNone);
  EXPECT_EQ(cause(10.0F, 0.0F), Cause::kLeader);
}

// GUARD-004 One stands across from the left, its front 1.12 m left of our line: beyond the strip of 0.9 + 0.2 m that is kept clear along it.
// 0.25 m left of the line our box reaches to 1.15 m: from 10 m/s and 10 m away that is too late to stop. On the line it passes.
TEST(Guard, WhoIsALittleOffItsLineLooksWhereItsBoxIs) {
  const auto cause = [](float from_m) {
    Change change;
    scene::Agent& across = add_vehicle(change.scene, change.map, path_of(change.map, {0}), 113.4F, 0.0F);
    across.track.centre.heading_rad = -0.5F * kPi;
    across.track.centre.y_m = 1.12F + 0.5F * across.track.length_m;
    return change.cause_across(10.0F, 0.0F, 0, from_m, from_m);
  };
  EXPECT_EQ(cause(0.0F), Cause::kNone);
  EXPECT_EQ(cause(0.25F), Cause::kLeader);
}

// GUARD-009 From rest, 1.2 m on our way over, beside one whose front is as far as our middle: 0.2 m are between us. While it stands
// we may go on past it at that distance, and not into it; one that rolls is a follower like any other, and has no room.
TEST(Guard, WhoStandsBesideUsIsPassedAsItStands) {
  const auto cause = [](float its_mps, float to_m) {
    Change change;
    change.in_left_lane(97.5F, its_mps);
    return change.cause_across(0.0F, 1.0F, 1, 1.2F, to_m);
  };
  EXPECT_EQ(cause(0.0F, 1.2F), Cause::kNone);
  EXPECT_EQ(cause(0.0F, kLaneWidthM), Cause::kFollower);
  EXPECT_EQ(cause(1.0F, 1.2F), Cause::kFollower);
}

}  // namespace
}  // namespace s4tp::safety
