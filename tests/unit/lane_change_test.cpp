// Changing lanes among others: what a start must leave them, and what is finished.

#include "algo/safety/lane_change.hpp"

#include <gtest/gtest.h>

#include "algo/safety/terminal.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Two lanes or more along +x, we at s = 100 of the right one, and a drive at constant speed into the next.
struct Change {
  LaneMap map;
  Scene scene;
  TrajectoryPoint start;
  Change(int lanes, float s_m, float speed_mps, float left_m, float heading_rad)
      : map(straight_road(lanes, 400.0F)) {
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    start = state_on(map, scene.ego_paths[0].path, s_m, speed_mps, left_m);
    start.rear_axle.heading_rad = heading_rad;
    put_ego(scene, start);
  }
  [[nodiscard]] Trajectory drive() const {
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      const float part = static_cast<float>(i) / 30.0F;
      TrajectoryPoint& point = trajectory.points[i];
      point = start;
      point.rear_axle.x_m += start.speed_mps * 3.0F * part;
      point.rear_axle.y_m += (kLaneWidthM - start.rear_axle.y_m) * part;
    }
    return trajectory;
  }
  [[nodiscard]] TerminalCause cause() const { return judge_terminal(scene, 1, drive(), Parameters{}).cause; }
};

// TERM-017 The line is 1.6 m to our left, the corner 4 m ahead and 0.9 m beside the rear axle: at rest, 0.6 m
// left of the centre and turned by 0.08, it is over the line by 0.2 m; not turned, 0.1 m short of it. From
// 0.5 m and turned by 0.03 it is 0.08 m short at rest, and over it within half a second at 10 m/s.
TEST(LaneChange, IsUnderWayWhenACornerIsOverTheLine) {
  const auto under_way = [](float speed_mps, float left_m, float heading_rad) {
    const Change change(2, 100.0F, speed_mps, left_m, heading_rad);
    return change_under_way(change.scene, change.scene.ego_paths[1], change.start, Parameters{});
  };
  EXPECT_TRUE(under_way(0.0F, 0.6F, 0.08F));
  EXPECT_FALSE(under_way(0.0F, 0.6F, 0.0F));
  EXPECT_FALSE(under_way(0.0F, 0.5F, 0.03F));
  EXPECT_TRUE(under_way(10.0F, 0.5F, 0.03F));
}

// TERM-017 Heading out of our own lane, 1.5 m from its centre, at 10 m/s: while a corner is in it, it is a
// lane we are in.
TEST(LaneChange, TheLaneLeftIsStillOurs) {
  const Change change(2, 100.0F, 10.0F, 1.5F, 0.2F);
  EXPECT_TRUE(change_under_way(change.scene, change.scene.ego_paths[0], change.start, Parameters{}));
}

// TERM-018 The one behind, 3 m/s faster, comes 1.5 m nearer in half a second and 1.5 m more while he brakes:
// with the half metre left he needs 3.5 m. One that we would meet at the end of the horizon only, from rest:
// at 10 m/s he needs 5 + 100 / 6 = 21.7 m.
TEST(LaneChange, WhoIsBehindBrakesGently) {
  const Trajectory at_ten = Change(2, 100.0F, 10.0F, 0.0F, 0.0F).drive();
  EXPECT_TRUE(can_stay_behind(3.7F, 13.0F, at_ten));
  EXPECT_FALSE(can_stay_behind(3.3F, 13.0F, at_ten));
  const Trajectory at_rest = Change(2, 100.0F, 0.0F, 0.0F, 0.0F).drive();
  EXPECT_TRUE(can_stay_behind(22.5F, 10.0F, at_rest));
  EXPECT_FALSE(can_stay_behind(21.5F, 10.0F, at_rest));
}

// TERM-018 At 10 m/s, one 10 m behind in the next lane at 13: he would be within a metre after 3 s, which a
// start does not ask of him. A change under way is finished in front of him, but not of one 3 m behind.
TEST(LaneChange, AChangeUnderWayIsFinished) {
  for (const float gap_m : {10.0F, 3.0F}) {
    for (const bool begun : {false, true}) {
      Change change(2, 100.0F, 10.0F, begun ? 0.6F : 0.0F, begun ? 0.08F : 0.0F);
      add_vehicle(change.scene, change.map, change.scene.ego_paths[1].path, 99.0F - gap_m - 2.5F, 13.0F);
      const bool safe = begun && gap_m > 5.0F;
      EXPECT_EQ(change.cause(), safe ? TerminalCause::kNone : TerminalCause::kFollower) << gap_m << begun;
    }
  }
}

// TERM-030 One as fast 3 m ahead in the next lane: a start keeps 4.75 m at 10 m/s; a change that the running
// plan leads to only must be able to stop behind him, with 3 + 100/16 - 100/12 = 0.9 m left. One who is 2 m/s
// slower is 6 m nearer after 3 s: then it is given up.
TEST(LaneChange, AChangeThePlanLeadsToIsBegun) {
  for (const float its_mps : {10.0F, 8.0F}) {
    for (const bool begun : {false, true}) {
      Change change(2, 100.0F, 10.0F, 0.0F, 0.0F);
      add_vehicle(change.scene, change.map, change.scene.ego_paths[1].path, 104.0F + 3.0F + 2.5F, its_mps);
      Plan running;
      running.kind = PlanKind::kDrive;
      running.start_ms = 5000;
      running.trajectory = change.drive();
      if (!begun) running.trajectory.points[kHorizonSteps].rear_axle.y_m = 1.0F;
      mark_bound_for(running, 5100, change.scene);
      EXPECT_EQ(change.scene.ego_paths[1].bound_for, begun);
      const bool safe = begun && its_mps > 9.0F;
      EXPECT_EQ(change.cause(), safe ? TerminalCause::kNone : TerminalCause::kLeader) << its_mps << begun;
    }
  }
}

// TERM-030 A plan that stops to be safe, or has run out, leads nowhere.
TEST(LaneChange, OnlyAPlanToDriveBegins) {
  Change change(2, 100.0F, 10.0F, 0.0F, 0.0F);
  Plan running;
  running.kind = PlanKind::kMinimumRisk;
  running.start_ms = 5000;
  running.trajectory = change.drive();
  mark_bound_for(running, 5100, change.scene);
  EXPECT_FALSE(change.scene.ego_paths[1].bound_for);
  running.kind = PlanKind::kDrive;
  mark_bound_for(running, 8100, change.scene);
  EXPECT_FALSE(change.scene.ego_paths[1].bound_for);
}

// TERM-019 Three lanes; one beside us, in the third, on his way into the second: we do not begin to change
// into it. When he keeps to his lane, we do; and who has begun already does not fall back to his side.
TEST(LaneChange, WhoJoinsTheLaneFromItsOtherSideCounts) {
  const auto cause = [](bool joins, bool begun) {
    Change change(3, 100.0F, 10.0F, begun ? 0.6F : 0.0F, begun ? 0.08F : 0.0F);
    Agent& beside = add_vehicle(change.scene, change.map, path_of(change.map, {2}), 101.0F, 10.0F, -0.3F);
    if (joins) (void)beside.paths.push(path_of(change.map, {1}));
    return change.cause();
  };
  EXPECT_EQ(cause(true, false), TerminalCause::kFollower);
  EXPECT_EQ(cause(false, false), TerminalCause::kNone);
  EXPECT_EQ(cause(true, true), TerminalCause::kNone);
}

// TERM-019 The same, his centre 12 m behind ours: 7 m from bumper to bumper are enough for one as fast (5.5
// needed), not for one who comes 3 m/s faster.
TEST(LaneChange, WhoJoinsTheLaneBehindUsFollowsThere) {
  for (const float speed_mps : {10.0F, 13.0F}) {
    Change change(3, 100.0F, 10.0F, 0.0F, 0.0F);
    Agent& behind =
        add_vehicle(change.scene, change.map, path_of(change.map, {2}), 101.5F - 12.0F, speed_mps);
    (void)behind.paths.push(path_of(change.map, {1}));
    EXPECT_EQ(change.cause(), speed_mps > 11.0F ? TerminalCause::kFollower : TerminalCause::kNone);
  }
}

// TERM-020 At 6 m/s from s = 360 the plan ends at 378 and stops at 384.5: past 381, from where one more
// change would fit before the road ends. Not to be begun, but to be finished.
TEST(LaneChange, AChangeUnderWayIsFinishedBeforeTheNext) {
  for (const bool begun : {false, true}) {
    Change change(2, 360.0F, 6.0F, begun ? 0.6F : 0.0F, begun ? 0.08F : 0.0F);
    for (Lane& lane : change.map.lanes) {
      lane.on_route = false;
      lane.changes_needed = 1;
    }
    EXPECT_EQ(change.cause(), begun ? TerminalCause::kNone : TerminalCause::kLaneEnd);
  }
}

}  // namespace
}  // namespace s4tp
