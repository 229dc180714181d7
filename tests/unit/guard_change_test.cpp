// Where the guard lets a plan come into a lane: merging, and changing lanes.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2, which builds up in 0.15 s (guard_test.cpp). Places are those of the box centre, 2.5 m
// behind the front bumper.

#include <gtest/gtest.h>

#include "algo/safety/guard.hpp"
#include "tests/support/lane_change_road.hpp"
#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

// GUARD-008 Into one lane, we first: from 84 at 12 m/s we come in after 1 s, and 1 s later are at 108, 4 m
// beyond the exit. The other, from 8 m/s gaining 2 m/s^2, has then covered 20 m and is no faster than we are:
// from 14 m before the zone it is 2 m before the exit, 6 m behind us; 5.5 m between the centres are needed.
TEST(Guard, MergingBeforeAnotherLeavesItRoomToBrake) {
  for (const float entry_m : {14.0F, 13.0F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.other(96.0F - entry_m, 8.0F);
    EXPECT_EQ(road.safe(84.0F, 12.0F, 0.0F), entry_m > 13.5F) << entry_m;
  }
}

// GUARD-008 From 90 at 8 m/s we come in after 0.75 s and 1 s later are at the exit. The other, from 8 m/s, has covered 17.06 m by then and
// drives 11.5 m/s: with the 2.5 m/s^2 of ordinary driving it takes 12.25 / 5 = 2.45 m to be no faster, beside the 5.5 m between the
// centres: it is to be 25.0 - 8 = 17.0 m before the zone. Once that way on has been begun the 4 m/s^2 that it owes do: 1.53 m, 16.1 m.
TEST(Guard, MergingAsksNobodyToBrakeHardBeforeItIsBegun) {
  for (const bool begun : {false, true}) {
    for (const float entry_m : {17.5F, 16.5F, 15.6F}) {
      SharedGround road(Priority::kFirstYields, true);
      scene::Agent& other = road.other(96.0F - 17.5F, 8.0F);
      if (begun) road.guard.commit(0, road.judge(90.0F, 8.0F, 0.0F));
      other.track.centre.x_m += 17.5F - entry_m;
      other.frenet[0].s_m += 17.5F - entry_m;
      EXPECT_EQ(road.safe(90.0F, 8.0F, 0.0F), entry_m > (begun ? 16.1F : 17.0F)) << begun << ' ' << entry_m;
    }
  }
}

// GUARD-008 The same where somebody stands further on, at 120: our centre stands at 120 - 5 - 0.5 = 114.5 at the furthest, and the other,
// 6 m behind our 108 with 12 m/s, 144 / 8 = 18 m further on: 6 + 6.5 - 18 is no room for 5.5. Behind one at 160 there is.
TEST(Guard, MergingBeforeAnotherLeavesItRoomBehindWhoeverLeads) {
  for (const float leader_m : {120.0F, 160.0F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.other(96.0F - 14.0F, 8.0F);
    road.leader(leader_m, 0.0F);
    EXPECT_EQ(road.safe(84.0F, 12.0F, 0.0F), leader_m > 140.0F) << leader_m;
  }
}

// GUARD-008 Into one lane, we second: from 92 at 5 m/s the fail-safe stops at 92 + 1.75 + 2.08 = 95.8. The
// other is in the zone at 97 and brakes with 8 m/s^2: from 7.5 m/s it stops at 100.5, 5.5 m before that is
// 95; from 9 m/s at 102.1, which leaves 96.6.
TEST(Guard, MergingBehindAnotherStopsBehindIt) {
  for (const float other_mps : {7.5F, 9.0F}) {
    SharedGround road(Priority::kFirstHasPriority, true);
    road.other(97.0F, other_mps);
    EXPECT_EQ(road.safe(92.0F, 5.0F, 0.0F), other_mps > 8.0F) << other_mps;
  }
}

// GUARD-003 The same where we give way, and need room beyond the zone: our centre at 104, so its own at 109.5. From 100 at
// 12 m/s it stops at 109, from 15 m/s at 114.
TEST(Guard, MergingBehindAnotherNeedsRoomBeyondTheZone) {
  for (const float other_mps : {12.0F, 15.0F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.other(100.0F, other_mps);
    EXPECT_EQ(road.cause(92.0F, 5.0F, 0.0F), other_mps > 13.0F ? Cause::kNone : Cause::kNoRoom) << other_mps;
  }
}

// GUARD-003 Nor behind one that is still before the zone, at 95, and certain to go first: we come in after 1 s, it is out after 0.9
// s from 14 m/s, braking with 8 m/s^2, and stops at 107; from 17.5 m/s at 114.
TEST(Guard, MergingBehindWhoGoesFirstNeedsRoomBeyondTheZone) {
  for (const float other_mps : {14.0F, 17.5F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.other(95.0F, other_mps);
    EXPECT_EQ(road.cause(88.0F, 8.0F, 0.0F), other_mps > 15.0F ? Cause::kNone : Cause::kNoRoom) << other_mps;
  }
}

// GUARD-002 GUARD-008 Where two lanes become one a vehicle stands, whoever owes whom the way, and for whatever reason: at 8 m/s,
// 0.1 s after 0.1 s, no plan passes that could not be left any more before our box is at its own. From there none does until it
// has been driven through: 36 in a row did once.
TEST(Guard, WhoStandsWhereLanesMergeIsNotDrivenThrough) {
  constexpr float kStop_m = 0.35F * 8.0F + 64.0F / 12.0F;
  for (const Priority priority :
       {Priority::kFirstYields, Priority::kFirstHasPriority, Priority::kFirstCome}) {
    for (const float at_m : {99.0F, 100.0F, 102.0F, 104.0F}) {
      for (const std::uint16_t stood_ms : {0, 1000}) {
        SharedGround road(priority, true);
        road.other(at_m, 0.0F).stood_ms = stood_ms;
        road.scene.waited_s = 1.0F;
        int refused = 0;
        for (float s_m = at_m - 40.0F; s_m < at_m; s_m += 0.8F) {
          if (road.safe(s_m, 8.0F, 0.0F)) {
            EXPECT_LE(s_m + kStop_m, at_m - 5.0F) << "stands at " << at_m;
          } else {
            ++refused;
          }
        }
        EXPECT_GE(refused, 16) << at_m;
        EXPECT_LE(refused, 40) << at_m;
      }
    }
  }
}

// GUARD-007 Who has come to a stand where lanes merge, later than it was to be gone, beside one that passes, stands on, and sets
// off when that is behind all of it: centres 5 m apart. Moving, it goes on: it cannot stay out any more.
TEST(Guard, WhoStandsWhereLanesMergeLetsTheOneBesideItPass) {
  for (const float other_s_m : {96.5F, 98.5F, 100.5F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.guard.commit(0, road.judge(94.0F, 8.0F, 0.0F));
    road.other(other_s_m, 2.0F);
    EXPECT_TRUE(road.safe(102.0F, 0.0F, 0.0F)) << other_s_m;
    EXPECT_EQ(road.safe(102.0F, 0.0F, 1.5F), other_s_m < 97.0F) << other_s_m;
    EXPECT_TRUE(road.safe(102.0F, 2.0F, 1.5F)) << other_s_m;
  }
}

// GUARD-007 Bound to go on at 97 with 5 m/s where lanes merge: one that is ahead of our centre by less than the two half lengths, 5 m,
// and faster is let go first, braking as the fail-safe does; one behind our centre, a slower one, or one ahead of all of us is not braked for.
TEST(Guard, WhoIsPassedWhereLanesMergeBrakes) {
  struct Case {
    float other_s_m;
    float other_mps;
    bool goes_on;
  };
  for (const Case& each : {Case{97.5F, 8.5F, false}, Case{99.0F, 8.5F, false}, Case{97.5F, 4.0F, true},
                           Case{96.5F, 8.5F, true}, Case{102.5F, 8.5F, true}}) {
    SharedGround road(Priority::kFirstYields, true);
    road.guard.commit(0, road.judge(94.0F, 8.0F, 0.0F));
    road.other(each.other_s_m, each.other_mps);
    EXPECT_EQ(road.cause(97.0F, 5.0F, 0.0F), each.goes_on ? Cause::kNone : Cause::kZone) << each.other_s_m;
    EXPECT_TRUE(road.safe(97.0F, 5.0F, -6.0F)) << each.other_s_m;
  }
}

// GUARD-005 From 92 at 5 m/s we can still stand at 93.6, before the zone at 96 (8 m/s^2), from 95.8 we cannot. One that comes with 8
// m/s 6 m before it cannot after its response (8 m), 20 m before it can (8 + 8 m).
TEST(Guard, SaysWhenOnlyWeCanStop) {
  struct Case {
    float s_m;
    float acceleration_mps2;
    float its_way_m;
    bool only_we;
  };
  for (const Case& each :
       {Case{92.0F, 0.0F, 6.0F, true}, Case{92.0F, 0.0F, 20.0F, false}, Case{95.8F, -0.5F, 6.0F, false}}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - each.its_way_m, 8.0F);
    const Verdict verdict = road.judge(each.s_m, 5.0F, each.acceleration_mps2);
    EXPECT_EQ(verdict.cause, Cause::kZone) << each.s_m << " " << each.its_way_m;
    EXPECT_EQ(verdict.only_we_can_stop, each.only_we) << each.s_m << " " << each.its_way_m;
  }
}

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
