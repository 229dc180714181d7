// Where the guard lets a plan come into a lane: merging, and changing lanes.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2 (guard_test.cpp). Places are those of the box centre, 2.5 m
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

// GUARD-008 Into one lane, we second: from 92 at 5 m/s the fail-safe stops at 92 + 1.75 + 2.08 = 95.8. The
// other is in the zone at 97 and brakes with 8 m/s^2: from 7.5 m/s it stops at 100.5, 5.5 m before that is
// 95; from 9 m/s at 102.1, which leaves 96.6.
TEST(Guard, MergingBehindAnotherStopsBehindIt) {
  for (const float other_mps : {7.5F, 9.0F}) {
    SharedGround road(Priority::kFirstYields, true);
    road.other(97.0F, other_mps);
    EXPECT_EQ(road.safe(92.0F, 5.0F, 0.0F), other_mps > 8.0F) << other_mps;
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

/// A change from the right lane to the left one, over within 3 s; our box centre is at 100.
struct Change : LaneChangeRoad {
  scene::Agent& in_left_lane(float s_m, float speed_mps) {
    return add_vehicle(scene, map, path_of(map, {1}), s_m, speed_mps);
  }
  [[nodiscard]] Cause cause(float speed_mps, float acceleration_mps2, int path = 1) {
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, 98.5F, speed_mps);
    put_ego(scene, start);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      trajectory.points[i] =
          trajectory::bicycle_step(trajectory.points[i - 1], acceleration_mps2, 0.0F, kStepS);
      if (path == 1) trajectory.points[i].rear_axle.y_m = kLaneWidthM * static_cast<float>(i) / 30.0F;
    }
    Guard guard;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(path, trajectory).cause;
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

// GUARD-009 One beside us, half a length back, leaves no room for a change at all.
TEST(Guard, NobodyChangesIntoOneBeside) {
  Change change;
  change.in_left_lane(97.5F, 10.0F);
  EXPECT_EQ(change.cause(10.0F, 0.0F), Cause::kFollower);
  EXPECT_EQ(change.cause(10.0F, 0.0F, 0), Cause::kNone);
}

// GUARD-009 A slow one ahead in the lane we come to is a leader like any other: 10 m/s need 3.5 + 8.3 + 0.5 =
// 12.3 m before one that stands.
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

}  // namespace
}  // namespace s4tp::safety
