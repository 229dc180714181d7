// When the guard lets a plan be driven.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2, which takes 0.15 s to build up: from 12 m/s it needs 4.2 + 12.9 =
// 17.1 m, from 6 m/s 2.1 + 3.4 = 5.5 m. Places are those of the box centre, 2.5 m behind the front bumper.

#include "algo/safety/guard.hpp"

#include <gtest/gtest.h>

#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

// GUARD-001 Whoever may come: who can still stop 0.7 m before the zone, at 95.3, may go on. 95.3 - 17.1
// = 78.2.
TEST(Guard, WhoCanStopBeforeTheZoneGoesOn) {
  SharedGround road(Priority::kFirstYields);
  road.other(78.0F, 12.0F);
  EXPECT_TRUE(road.safe(78.1F, 12.0F, 0.0F));
  EXPECT_FALSE(road.judge(78.1F, 12.0F, 0.0F).clears);
  const Verdict verdict = road.judge(78.4F, 12.0F, 0.0F);
  EXPECT_EQ(verdict.cause, Cause::kZone);
  EXPECT_EQ(verdict.agent, 0);
}

// GUARD-001 It is the plan's own speed when it can be left that counts: 1.2 m/s more after 0.35 s with 3.5
// m/s^2, and 0.24 s until that has become braking, take 4.4 m more.
TEST(Guard, WhoSpeedsUpNeedsMoreRoom) {
  SharedGround road(Priority::kFirstYields);
  road.other(78.0F, 12.0F);
  EXPECT_FALSE(road.safe(74.2F, 12.0F, 3.5F));
  EXPECT_TRUE(road.safe(73.4F, 12.0F, 3.5F));
}

// GUARD-002 With nobody about, the plan goes through: 24 m to the exit at 12 m/s.
TEST(Guard, AnEmptyZoneIsDrivenThrough) {
  SharedGround road(Priority::kFirstYields);
  const Verdict verdict = road.judge(85.0F, 12.0F, 0.0F);
  EXPECT_TRUE(verdict.safe());
  EXPECT_TRUE(verdict.clears);
}

// GUARD-002 From 84 at 12 m/s we leave the zone after 20 m / 12 m/s = 1.67 s, between two steps of the plan. The other gains 2 m/s^2 from 12 to 15.28
// m/s: 23.2 m in 1.7 s. 22 m before the zone it is too near; at 26 m (1.9 s) we are gone before it can be
// there.
TEST(Guard, WhoIsGoneBeforeAnybodyCanComeNeedsNoLicence) {
  for (const float way_m : {22.0F, 26.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - way_m, 12.0F);
    const Verdict verdict = road.judge(84.0F, 12.0F, 0.0F);
    EXPECT_EQ(verdict.cause, way_m < 25.0F ? Cause::kZone : Cause::kNone) << way_m;
    if (verdict.safe()) continue;
    EXPECT_NEAR(verdict.from_s, 1.63F, 0.05F);
    EXPECT_NEAR(verdict.needed_s, 1.667F, 0.01F);
  }
}

// GUARD-002 From the line at 95.3 with 2 m/s^2 the exit is 2.95 s away. One 20 m off at 5 m/s may come in 2.6
// s, and could not stop gently (9.75 m to 8 m/s, 16 m, 0.5 m short); at 30 m it could (L1): the entry is
// licensed.
TEST(Guard, AnEntryAgainstPriorityNeedsALicence) {
  for (const float way_m : {20.0F, 30.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - way_m, 5.0F);
    EXPECT_EQ(road.safe(95.3F, 0.0F, 2.0F), way_m > 25.0F) << way_m;
  }
}

// GUARD-002 Of two who come, the one without licence is in the way; behind one who stays out of the zone
// nobody of its lane comes.
TEST(Guard, NobodyDrivesThroughTheOneAhead) {
  SharedGround road(Priority::kFirstYields);
  road.other(96.0F - 30.0F, 12.0F);
  EXPECT_FALSE(road.safe(95.3F, 0.0F, 2.0F));
  scene::Agent& ahead = road.other(96.0F - 6.0F, 0.0F);
  ahead.stood_ms = 1000;
  road.scene.waited_s = 1.0F;
  EXPECT_TRUE(road.safe(95.3F, 0.0F, 2.0F));
}

// GUARD-002 One that stands at the zone's far end, its rear 0.4 m beside our box, lets the next one drive up
// to it once both have stood for 2 s: 2.8 m into the zone.
TEST(Guard, WhoStandsInTheZoneLetsTheNextOneIn) {
  SharedGround road(Priority::kFirstYields);
  scene::Agent& ahead = road.other(103.8F, 0.0F);
  ahead.stood_ms = 2000;
  road.scene.waited_s = 2.0F;
  EXPECT_TRUE(road.safe(95.3F, 0.0F, 2.0F));
  road.other(96.0F - 12.0F, 8.0F);
  EXPECT_FALSE(road.safe(95.3F, 0.0F, 2.0F));
}

// GUARD-002 2 m before the zone's exit at 10 m/s it cannot stop in the zone (6.25 m) and is out after 0.22 s;
// we come in 1 s. At 4 m/s it could (1 m).
TEST(Guard, WhoIsCertainToHaveLeftIsNotInTheWay) {
  for (const float speed_mps : {10.0F, 4.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.other(102.0F, speed_mps);
    EXPECT_EQ(road.safe(86.0F, 10.0F, 0.0F), speed_mps > 5.0F) << speed_mps;
  }
}

// GUARD-002 Who owes us the way and can stop does not block us; who cannot does. 12 m/s: 144 / 8 = 18 m.
TEST(Guard, WhoOwesUsTheWayIsTrustedToStop) {
  for (const float way_m : {19.0F, 17.0F}) {
    SharedGround road(Priority::kFirstHasPriority);
    road.other(96.0F - way_m, 12.0F);
    EXPECT_EQ(road.safe(86.0F, 12.0F, 0.0F), way_m > 18.0F) << way_m;
  }
}

// GUARD-003 Nobody who gives way comes to rest in a zone. From 93 at 8 m/s 5 m/s^2 end at 99.4; from the line
// at 0.2 m/s nothing is covered in 3 s.
TEST(Guard, NobodyStopsInAZone) {
  SharedGround road(Priority::kFirstYields);
  EXPECT_EQ(road.cause(93.0F, 8.0F, -5.0F), Cause::kNoRoom);
  EXPECT_TRUE(road.safe(93.0F, 8.0F, 0.0F));
}

// GUARD-003 Room beyond the exit for the case that the leader brakes with 8 m/s^2: our front stands at 106.5
// when we are out, and the fail-safe stops 0.5 m behind it. A car of 5 m at 8 m/s stops 4 m on: its centre must
// be at 105.5 or beyond. Standing, at 109.5.
TEST(Guard, TheZoneIsEnteredWhenThereIsRoomBeyondIt) {
  const auto enters = [](float leader_s_m, float leader_mps, Priority priority) {
    SharedGround road(priority);
    road.leader(leader_s_m, leader_mps);
    return road.cause(94.5F, 2.0F, 1.0F);
  };
  EXPECT_EQ(enters(105.7F, 8.0F, Priority::kFirstYields), Cause::kNone);
  EXPECT_EQ(enters(105.3F, 8.0F, Priority::kFirstYields), Cause::kNoRoom);
  EXPECT_EQ(enters(109.7F, 0.0F, Priority::kFirstYields), Cause::kNone);
  EXPECT_EQ(enters(109.3F, 0.0F, Priority::kFirstYields), Cause::kNoRoom);
  EXPECT_EQ(enters(108.8F, 0.0F, Priority::kFirstHasPriority), Cause::kNone);
}

// GUARD-002 Whoever leads may brake hard while we are in the zone. From 86 at 10 m/s the plan is out after 1.8 s. Behind one that
// stands at 110 our centre stands at 104.5: 8.3 m of braking are due at 96, after 1 s, and then it is out after 2.33 s. One at
// 15.3 m/s comes after 2.1 s from 32 m before the zone, after 2.7 s from 41 m.
TEST(Guard, WhoBrakesBehindALeaderIsOutOfTheZoneInTimeToo) {
  const auto cause = [](float way_m, bool leader) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - way_m, 1.1F * kLimitMps);
    if (leader) road.leader(110.0F, 0.0F);
    return road.cause(86.0F, 10.0F, 0.0F);
  };
  EXPECT_EQ(cause(32.0F, false), Cause::kNone);
  EXPECT_EQ(cause(32.0F, true), Cause::kZone);
  EXPECT_EQ(cause(41.0F, true), Cause::kNone);
}

// GUARD-003 Two zones 0.9 m apart are one group: before the first one it takes the licence of the second. 2 m
// apart one can wait between them.
TEST(Guard, ZonesWithoutRoomBetweenAreOneGroup) {
  for (const float between_m : {0.9F, 3.0F}) {
    SharedGround road(Priority::kFirstHasPriority);
    scene::ConflictZone next = road.zone();
    next.entry_s_m = 104.0F + between_m;
    next.exit_s_m = next.entry_s_m + 6.0F;
    next.priority = Priority::kFirstYields;
    next.other_entry_m = 100.0F;
    next.other_exit_m = 106.0F;
    (void)road.scene.ego_paths[0].zones.push(next);
    // It leaves the first zone to us, or has left it; in the second one it may go on standing.
    road.other(104.1F, 1.0F);
    EXPECT_EQ(road.cause(95.0F, 2.0F, 0.0F), between_m < 1.0F ? Cause::kZone : Cause::kNone) << between_m;
  }
}

// GUARD-004 12 m/s behind 12 m/s, who stops in 9 m: 17.1 + 0.5 - 9 = 8.6 m between the bumpers are enough if
// nothing but the plan is to be left. Who speeds up needs more; who comes nearer on purpose is refused.
TEST(Guard, TheLeaderMayBrakeHard) {
  const auto behind = [](float gap_m, float own_mps, float acceleration_mps2, float leader_mps) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    road.leader(20.0F + 5.0F + gap_m, leader_mps);
    return road.cause(20.0F, own_mps, acceleration_mps2);
  };
  EXPECT_EQ(behind(8.7F, 12.0F, 0.0F, 12.0F), Cause::kNone);
  EXPECT_EQ(behind(8.7F, 12.0F, 2.0F, 12.0F), Cause::kLeader);
  EXPECT_EQ(behind(13.0F, 12.0F, 2.0F, 12.0F), Cause::kNone);
  EXPECT_EQ(behind(17.7F, 12.0F, 0.0F, 0.0F), Cause::kNone);
}

// GUARD-004 Turned by 0.25 rad our box reaches 0.9 m * sin(0.25) = 0.22 m further along the lane: 8.7 m, enough when it is straight, is
// too little, and 9.0 m are enough.
TEST(Guard, WhoIsAskewInItsLaneReachesFurther) {
  const auto behind = [](float gap_m, float turned_rad) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    road.leader(20.0F + 5.0F + gap_m, 12.0F);
    return road.judge(20.0F, 12.0F, 0.0F, turned_rad).cause;
  };
  EXPECT_EQ(behind(8.7F, 0.0F), Cause::kNone);
  for (const float turned_rad : {-0.25F, 0.25F}) {
    EXPECT_EQ(behind(8.7F, turned_rad), Cause::kLeader) << turned_rad;
    EXPECT_EQ(behind(9.0F, turned_rad), Cause::kNone) << turned_rad;
  }
}

// GUARD-004 The 0.5 m kept cover a vehicle that is so far ahead of its plan: 8.7 m are enough then, too. 0.8 m ahead it takes 0.3 m
// more. One that is late is on its way to where its plan has it.
TEST(Guard, WhoIsAheadOfItsPlanIsJudgedFromThere) {
  const auto behind = [](float gap_m, float ahead_m) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    road.leader(20.0F + 5.0F + gap_m, 12.0F);
    return road.judge(20.0F, 12.0F, 0.0F, 0.0F, ahead_m).cause;
  };
  EXPECT_EQ(behind(8.7F, 0.5F), Cause::kNone);
  EXPECT_EQ(behind(8.7F, -0.8F), Cause::kNone);
  EXPECT_EQ(behind(8.7F, 0.8F), Cause::kLeader);
  EXPECT_EQ(behind(9.0F, 0.8F), Cause::kNone);
}

// GUARD-004 One that stands askew, turned by 128 degrees, has its front 6 cm from our corner: every metre we go on brings us 0.62 m nearer.
// From rest nothing sets off into it, however gently, and what stands passes. 2 m away a start passes that stops before it.
TEST(Guard, NobodyCreepsIntoOneThatStandsAskew) {
  const auto cause = [](float away_m, float acceleration_mps2) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    scene::Agent& askew = road.leader(54.0F, 0.0F);
    askew.track.centre = {-45.76F + away_m, -2.77F, 2.24F};
    return road.cause(50.0F, 0.0F, acceleration_mps2);
  };
  EXPECT_EQ(cause(0.0F, 0.0F), Cause::kNone);
  EXPECT_EQ(cause(0.0F, 0.3F), Cause::kLeader);
  EXPECT_EQ(cause(0.0F, 2.0F), Cause::kLeader);
  EXPECT_EQ(cause(2.0F, 0.3F), Cause::kNone);
}

// GUARD-004 In a right turn of 6 m, at its beginning, our front, 3.9 m before the rear axle, is 1.2 m left of the path: one stands across
// there whose near corner is 0.3 m before it and 0.4 m within its width. 4 m further left it stands beside our way.
TEST(Guard, OurFrontKeepsOffWhoStandsWhereItSwingsOut) {
  const auto cause = [](float left_m) {
    LaneMap map;
    scene::Scene scene;
    const Parameters parameters;
    const LaneIndex before = add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex turn = add_lane(map, arc({0.0F, 0.0F, 0.0F}, 6.0F, -2.0944F, 9));
    link(map, before, turn);
    const scene::LanePath path = path_of(map, {before, turn});
    (void)add_ego_path(scene, map, path);
    const TrajectoryPoint start = state_on(map, path, 60.0F, 2.0F);
    put_ego(scene, start);
    scene::Agent& across = add_vehicle(scene, map, path_of(map, {before}), 55.0F, 0.0F);
    across.lane = kNoLaneIndex;
    across.paths.clear();
    const float front_m = trajectory::rear_axle_to_front_m(parameters);
    across.track.centre = {front_m + 0.3F + 0.5F * across.track.width_m,
                           0.5F + 0.5F * across.track.length_m + left_m, 0.5F * kPi};
    Trajectory plan;
    for (int i = 0; i < kTrajectoryPoints; ++i)
      plan.points[i] = state_on(map, path, 60.0F + 2.0F * kStepS * static_cast<float>(i), 2.0F);
    Guard guard;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(0, plan).cause;
  };
  EXPECT_EQ(cause(0.0F), Cause::kLeader);
  EXPECT_NE(cause(4.0F), Cause::kLeader);
}

// GUARD-004 Towards one that stands, 12 m/s are kept up to 17.6 m before it and no longer.
TEST(Guard, NobodyGoesOnTowardsOneWhoStands) {
  SharedGround road(Priority::kFirstHasPriority);
  road.scene.ego_paths[0].zones.clear();
  road.leader(20.0F + 5.0F + 17.4F, 0.0F);
  EXPECT_EQ(road.cause(20.0F, 12.0F, 0.0F), Cause::kLeader);
  EXPECT_EQ(road.cause(20.0F, 12.0F, -6.0F), Cause::kNone);
}

// GUARD-004 One seen last 0.3 s ago may have begun to brake then: 3.6 m nearer.
TEST(Guard, AnOldSightingCounts) {
  for (const std::uint16_t age_ms : {std::uint16_t{0}, std::uint16_t{300}}) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    scene::Agent& leader = road.leader(20.0F + 5.0F + 10.0F, 12.0F);
    leader.age_ms = age_ms;
    leader.coasted_m = 0.012F * static_cast<float>(age_ms);
    EXPECT_EQ(road.cause(20.0F, 12.0F, 0.2F), age_ms == 0 ? Cause::kNone : Cause::kLeader) << age_ms;
  }
}

// GUARD-004 One as fast as we are has come in 3 m before us: keeping the speed makes it no worse, speeding up
// does; braking is always allowed.
TEST(Guard, BehindACutInItOnlyMustNotGetWorse) {
  SharedGround road(Priority::kFirstHasPriority);
  road.scene.ego_paths[0].zones.clear();
  road.leader(20.0F + 5.0F + 3.0F, 12.0F);
  EXPECT_EQ(road.cause(20.0F, 12.0F, 0.0F), Cause::kNone);
  EXPECT_EQ(road.cause(20.0F, 12.0F, -3.0F), Cause::kNone);
  EXPECT_EQ(road.cause(20.0F, 12.0F, 1.0F), Cause::kLeader);
}

// GUARD-001 On a road that ends at 60 the front stops before: 60 - 2.5 - 17.1 = 40.4.
TEST(Guard, TheRoadMayEnd) {
  SharedGround road(Priority::kFirstHasPriority);
  road.map.lanes[0].on_route = false;
  road.map.lanes[0].points[1].x_m = -40.0F;
  road.map.lanes[0].length_m = road.ours.length_m = 60.0F;
  road.scene.ego_paths[0].path = road.ours;
  road.scene.ego_paths[0].zones.clear();
  EXPECT_EQ(road.cause(40.3F, 12.0F, 0.0F), Cause::kNone);
  EXPECT_EQ(road.cause(40.6F, 12.0F, 0.0F), Cause::kRoadEnd);
  EXPECT_EQ(road.cause(59.0F, 0.0F, 0.0F), Cause::kNone) << "who stands may go on standing";
  EXPECT_EQ(road.cause(59.0F, 0.0F, 2.0F), Cause::kRoadEnd);
  EXPECT_EQ(road.cause(59.0F, 0.0F, 0.3F), Cause::kRoadEnd) << "nor may it creep on";
  EXPECT_EQ(road.cause(59.0F, 6.0F, -6.0F), Cause::kNone) << "who cannot stop before it any more brakes";
  EXPECT_EQ(road.cause(59.0F, 6.0F, 0.0F), Cause::kNone) << "within half of the fail-safe's braking";
}

// GUARD-001 Whoever stands 0.3 m before the zone goes on standing; it need not go back to 0.7 m. It may not
// roll on from there, nor creep: 0.3 m/s^2 are 2 cm a cycle. Who still rolls at 0.2 m/s may stop.
TEST(Guard, WhoStandsNearTheZoneMayGoOnStanding) {
  SharedGround road(Priority::kFirstYields);
  road.other(80.0F, 10.0F);
  EXPECT_TRUE(road.safe(95.7F, 0.0F, 0.0F));
  EXPECT_FALSE(road.judge(95.7F, 0.0F, 0.0F).clears);
  EXPECT_FALSE(road.safe(95.7F, 0.0F, 2.0F));
  EXPECT_FALSE(road.safe(95.5F, 0.0F, 0.3F));
  EXPECT_TRUE(road.safe(95.5F, 0.2F, -2.0F));
}

// GUARD-005 To stop at 95.3 with 6 m/s^2 but not with 2.5 (4.2 + 28.8 m) is hard, when somebody may be in the
// zone; not with 35 m left, and not when nobody comes.
TEST(Guard, ReliesOnHardBraking) {
  SharedGround road(Priority::kFirstYields);
  road.other(66.0F, 12.0F);
  EXPECT_TRUE(road.judge(75.0F, 12.0F, 0.0F).hard);
  EXPECT_FALSE(road.judge(60.0F, 12.0F, 0.0F).hard);
  road.scene.agents.clear();
  EXPECT_FALSE(road.judge(75.0F, 12.0F, 0.0F).hard);
}

// GUARD-001 Nothing is passed without a map, a path or a look.
TEST(Guard, NoPathIsNotSafe) {
  EXPECT_EQ(Guard().judge(0, Trajectory{}).cause, Cause::kNoPath);
  SharedGround road(Priority::kFirstYields);
  road.scene.ego_paths.clear();
  EXPECT_EQ(road.cause(50.0F, 5.0F, 0.0F), Cause::kNoPath);
  SharedGround no_map(Priority::kFirstYields);
  const Verdict empty = no_map.judge(50.0F, 5.0F, 0.0F);
  EXPECT_TRUE(empty.safe());
  EXPECT_EQ(no_map.guard.judge(1, Trajectory{}).cause, Cause::kNoPath);
}

}  // namespace
}  // namespace s4tp::safety
