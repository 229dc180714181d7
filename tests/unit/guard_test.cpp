// When the guard lets a plan be driven.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2: from 12 m/s it needs 4.2 + 12 = 16.2 m, from 6
// m/s 2.1 + 3 = 5.1 m. Places are those of the box centre, 2.5 m behind the front bumper.

#include "algo/safety/guard.hpp"

#include <gtest/gtest.h>

#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Behind the first zone, with a lane of its own, from where it is as far as to the first.
/// \return the way of those who come there
scene::LanePath add_second_zone(SharedGround& road, float entry_s_m, float exit_s_m) {
  scene::ConflictZone zone = road.zone();
  zone.entry_s_m = entry_s_m;
  zone.exit_s_m = exit_s_m;
  zone.other_lane = add_lane(road.map, {{14.0F, -100.0F}, {14.0F, 300.0F}});
  (void)road.scene.ego_paths[0].zones.push(zone);
  return path_of(road.map, {zone.other_lane});
}

// GUARD-001 Whoever may come: who can still stop 0.7 m before the zone, at 95.3, may go on. 95.3 - 16.2
// = 79.1.
TEST(Guard, WhoCanStopBeforeTheZoneGoesOn) {
  SharedGround road(Priority::kFirstYields);
  road.other(78.0F, 12.0F);
  EXPECT_TRUE(road.safe(79.0F, 12.0F, 0.0F));
  EXPECT_FALSE(road.judge(79.0F, 12.0F, 0.0F).clears);
  const Verdict verdict = road.judge(79.3F, 12.0F, 0.0F);
  EXPECT_EQ(verdict.cause, Cause::kZone);
  EXPECT_EQ(verdict.agent, 0);
}

// GUARD-001 It is the plan's own speed when it can be left that counts: 1.4 m/s more after 0.4 s with 3.5
// m/s^2 take about 3.5 m more.
TEST(Guard, WhoSpeedsUpNeedsMoreRoom) {
  SharedGround road(Priority::kFirstYields);
  road.other(78.0F, 12.0F);
  EXPECT_FALSE(road.safe(79.0F, 12.0F, 3.5F));
  EXPECT_TRUE(road.safe(75.0F, 12.0F, 3.5F));
}

// GUARD-002 With nobody about, the plan goes through: 24 m to the exit at 12 m/s.
TEST(Guard, AnEmptyZoneIsDrivenThrough) {
  SharedGround road(Priority::kFirstYields);
  const Verdict verdict = road.judge(85.0F, 12.0F, 0.0F);
  EXPECT_TRUE(verdict.safe());
  EXPECT_TRUE(verdict.clears);
}

// GUARD-002 From 84 at 12 m/s we leave the zone after 1.7 s. The other gains 2 m/s^2 from 12 to 15.28
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
    EXPECT_NEAR(verdict.needed_s, 1.7F, 0.05F);
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
// to it: 2.8 m into the zone.
TEST(Guard, WhoStandsInTheZoneLetsTheNextOneIn) {
  SharedGround road(Priority::kFirstYields);
  scene::Agent& ahead = road.other(103.8F, 0.0F);
  ahead.stood_ms = 1000;
  road.scene.waited_s = 1.0F;
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

// GUARD-002 Who owes us the way and can stop does not hold us up; who cannot does. 12 m/s: 144 / 8 = 18 m.
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

// GUARD-004 12 m/s behind 12 m/s, who stops in 9 m: 16.2 + 0.5 - 9 = 7.7 m between the bumpers are enough if
// nothing but the plan is to be left. Who speeds up needs more; who comes nearer on purpose is refused.
TEST(Guard, TheLeaderMayBrakeHard) {
  const auto behind = [](float gap_m, float own_mps, float acceleration_mps2, float leader_mps) {
    SharedGround road(Priority::kFirstHasPriority);
    road.scene.ego_paths[0].zones.clear();
    road.leader(20.0F + 5.0F + gap_m, leader_mps);
    return road.cause(20.0F, own_mps, acceleration_mps2);
  };
  EXPECT_EQ(behind(7.8F, 12.0F, 0.0F, 12.0F), Cause::kNone);
  EXPECT_EQ(behind(7.8F, 12.0F, 2.0F, 12.0F), Cause::kLeader);
  EXPECT_EQ(behind(13.0F, 12.0F, 2.0F, 12.0F), Cause::kNone);
  EXPECT_EQ(behind(16.8F, 12.0F, 0.0F, 0.0F), Cause::kNone);
}

// GUARD-004 Towards one that stands, 12 m/s are kept up to 16.7 m before it and no longer.
TEST(Guard, NobodyGoesOnTowardsOneWhoStands) {
  SharedGround road(Priority::kFirstHasPriority);
  road.scene.ego_paths[0].zones.clear();
  road.leader(20.0F + 5.0F + 16.5F, 0.0F);
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

// GUARD-001 On a road that ends at 60 the front stops before: 60 - 2.5 - 16.2 = 41.3.
TEST(Guard, TheRoadMayEnd) {
  SharedGround road(Priority::kFirstHasPriority);
  road.map.lanes[0].on_route = false;
  road.map.lanes[0].points[1].x_m = -40.0F;
  road.map.lanes[0].length_m = road.ours.length_m = 60.0F;
  road.scene.ego_paths[0].path = road.ours;
  road.scene.ego_paths[0].zones.clear();
  EXPECT_EQ(road.cause(41.2F, 12.0F, 0.0F), Cause::kNone);
  EXPECT_EQ(road.cause(41.5F, 12.0F, 0.0F), Cause::kRoadEnd);
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

// GUARD-006 A licence used is not withdrawn half way: 40 m off at 6 m/s it can stop gently (32 m), and we
// commit ourselves. 8 m off it could not be asked any more; to us it still stays out. To one who has not committed, or
// has given it up since, it does not; nor to one who was to be out after 2.4 s, and at a steady 3 m/s is after 2.9.
TEST(Guard, ALicenceUsedHolds) {
  for (const bool committed : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - 40.0F, 6.0F);
    const Verdict begun = road.judge(94.0F, 3.0F, 1.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    if (committed) road.guard.commit(0, begun);
    road.scene.agents.clear();
    road.other(96.0F - 8.0F, 6.0F);
    EXPECT_EQ(road.safe(95.2F, 3.0F, 1.0F), committed);
    EXPECT_FALSE(road.safe(95.2F, 3.0F, 0.0F));
  }
  SharedGround road(Priority::kFirstYields);
  road.other(96.0F - 40.0F, 6.0F);
  road.guard.commit(0, road.judge(94.0F, 3.0F, 1.0F));
  road.guard.commit(0, road.judge(80.0F, 0.0F, 0.0F));  // it stops before the zone after all
  road.scene.agents.clear();
  road.other(96.0F - 8.0F, 6.0F);
  EXPECT_FALSE(road.safe(95.2F, 3.0F, 0.0F));
}

// GUARD-006 A licence is used by going. Half a metre into the zone at 0.5 m/s it holds; to who has come to a stand
// there, and was to be out sooner than from rest, the one that comes is asked anew.
TEST(Guard, WhoHasComeToAStandAsksAnew) {
  for (const float speed_mps : {0.5F, 0.0F}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - 40.0F, 6.0F);
    road.guard.commit(0, road.judge(94.0F, 3.0F, 1.0F));
    road.scene.agents.clear();
    road.other(96.0F - 8.0F, 6.0F);
    EXPECT_EQ(road.safe(96.5F, speed_mps, 2.0F), speed_mps > 0.0F) << speed_mps;
  }
}

// GUARD-006 Both stand, it in sight of us (L2), and we set off. Then it does too, at 1 m/s 8 m before the zone
// (0.35 s at our speed, then the way of a stop with 6 m/s^2). At 95.4 and 0.8 m/s we can still stand at 95.73,
// before the zone at 96: the licence is not used, and we do. At 95.4 and 1.6 m/s that would be 96.17: it holds.
TEST(Guard, ALicenceIsNotUsedBeforeWeAreBound) {
  for (const float speed_mps : {0.8F, 1.6F}) {
    SharedGround road(Priority::kFirstYields);
    road.other(96.0F - 8.0F, 0.0F).stood_ms = 1000;
    road.scene.waited_s = 1.0F;
    const Verdict begun = road.judge(95.3F, 0.0F, 2.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    road.scene.agents.clear();
    road.other(96.0F - 8.0F, 3.0F);
    const Verdict now = road.judge(95.4F, speed_mps, 2.0F);
    EXPECT_TRUE(now.safe()) << speed_mps;
    EXPECT_EQ(now.stops_short, speed_mps < 1.0F) << speed_mps;
  }
}

// GUARD-006 It lets us go (L1: 40 m away, 6 m/s), we do, and it gains speed. At 95.5 and 5 m/s 8 m/s^2 end at
// 97.1, in the zone: going on is what was licensed, and out in 1.7 s. It could still stop for us, 14 m after a
// second where 4.5 would do, but nobody brakes for it who was let go.
TEST(Guard, WhoWasLetGoDoesNotBreakOff) {
  SharedGround road(Priority::kFirstYields);
  road.other(96.0F - 40.0F, 6.0F);
  const Verdict begun = road.judge(94.0F, 4.5F, 1.0F);
  ASSERT_TRUE(begun.safe() && begun.clears);
  road.guard.commit(0, begun);
  road.scene.agents.clear();
  road.other(96.0F - 20.0F, 6.0F).track.acceleration_mps2 = 2.0F;
  EXPECT_TRUE(road.safe(95.5F, 5.0F, 1.0F));
  EXPECT_FALSE(road.safe(95.5F, 5.0F, -6.0F));
}

// GUARD-011 Gone in as nobody was near, to be out in 1.8 s. Who can be there after 2.4 s (20 m at 6 m/s, 2 m/s^2) is no
// reason to stop; who is there after 1.4 s (6 m at 3 m/s), and can still stop for us, is.
TEST(Guard, NobodyStopsShortOfWhoComesWhenWeAreGone) {
  for (const bool late : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    const Verdict begun = road.judge(94.0F, 4.5F, 1.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    road.other(late ? 96.0F - 20.0F : 96.0F - 6.0F, late ? 6.0F : 3.0F).track.acceleration_mps2 = 2.0F;
    EXPECT_TRUE(road.safe(95.5F, 5.0F, 1.0F));
    EXPECT_EQ(road.safe(95.5F, 5.0F, -6.0F), !late) << late;
  }
}

// GUARD-006 A licence holds for the ground it was given for. At 10 m/s, 26 m before the first zone, the other
// owes us the way; 40 m before the second, where it goes first, it comes after 3.1 s, and we are gone
// after 2.5 s. It breaks its duty, and is 5 m before the second zone, which we enter after 1.2 s: nobody said
// it would stay out of that. From 95 m at 8 m/s we stand at 103.1, short of it; from 98 m nowhere short of it.
TEST(Guard, ALicenceHoldsForItsZone) {
  SharedGround road(Priority::kFirstHasPriority);
  const LaneIndex beyond = add_lane(road.map, {{0.0F, 0.0F}, {6.0F, 2.0F}, {50.0F, 2.0F}});
  scene::ConflictZone& first = road.zone();
  Lane& before = road.map.lanes[first.other_lane];
  before.points[1].y_m = 0.0F;
  before.length_m = road.theirs.length_m = 100.0F;
  link(road.map, first.other_lane, beyond);
  first.other_entry_m = 86.0F;
  first.other_exit_m = 94.0F;
  scene::ConflictZone second = first;
  second.entry_s_m = 104.5F;
  second.exit_s_m = 110.0F;
  second.other_lane = beyond;
  second.other_entry_m = 0.0F;
  second.other_exit_m = 8.0F;
  second.priority = Priority::kFirstYields;
  (void)road.scene.ego_paths[0].zones.push(second);
  road.other(60.0F, 10.0F);
  const Verdict begun = road.judge(90.0F, 8.0F, 0.0F);
  ASSERT_TRUE(begun.safe() && begun.clears);
  road.guard.commit(0, begun);
  road.scene.agents.clear();
  road.other(95.0F, 12.0F);
  EXPECT_TRUE(road.judge(95.0F, 8.0F, 0.0F).stops_short);
  EXPECT_FALSE(road.safe(98.0F, 8.0F, 0.0F));
}

// GUARD-011 Gone in by right at 6 m/s, from 97 m we stand at 102.1, short of the second zone at 104.5, whose
// vehicle is nearly there. Another one with priority at the ground we would stand on: 30 m off at 8 m/s it stops
// for us there (8 m with 4 m/s^2; it has known us for long); 5 m off it cannot.
TEST(Guard, StopsShortOnlyWhereOthersCanStopForIt) {
  for (const float off_m : {30.0F, 5.0F}) {
    SharedGround road(Priority::kFirstYields);
    const scene::LanePath beside = add_second_zone(road, 104.5F, 110.0F);
    const Verdict begun = road.judge(94.0F, 6.0F, 0.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    add_vehicle(road.scene, road.map, beside, 96.0F - 4.0F, 8.0F);
    road.other(96.0F - off_m, 8.0F);
    EXPECT_EQ(road.safe(97.0F, 6.0F, 0.0F), off_m > 20.0F) << off_m;
  }
}

// GUARD-006 A licence is used by who goes through its group: 40 m off at 6 m/s it could stop gently before
// both of two groups 6 m apart. Leaving the first one at 103.9 and 8 m/s we could not stop at ease before the
// second; it is 8 m before that now, and has not been asked to stay out of it.
TEST(Guard, LicencesOfLaterGroupsAreNotUsedYet) {
  SharedGround road(Priority::kFirstYields);
  const scene::LanePath beside = add_second_zone(road, 110.0F, 118.0F);
  add_vehicle(road.scene, road.map, beside, 96.0F - 40.0F, 6.0F);
  const Verdict begun = road.judge(94.0F, 8.0F, 0.0F);
  ASSERT_TRUE(begun.safe() && begun.clears);
  road.guard.commit(0, begun);
  road.scene.agents.clear();
  add_vehicle(road.scene, road.map, beside, 96.0F - 8.0F, 6.0F);
  EXPECT_FALSE(road.safe(103.9F, 8.0F, 0.0F));
}

// GUARD-007 In a zone, with one who may come in 0.9 s, we are out after 0.5 s at 8 m/s. At 96.5 and 5 m/s we
// are not, and cannot stay out any more: we go on, and do not stop in it.
TEST(Guard, WhoIsInTheZoneLeavesIt) {
  SharedGround road(Priority::kFirstYields);
  road.other(96.0F - 12.0F, 12.0F);
  EXPECT_TRUE(road.safe(100.0F, 8.0F, 0.0F));
  EXPECT_TRUE(road.safe(96.5F, 5.0F, 0.0F));
  EXPECT_FALSE(road.safe(96.5F, 5.0F, -4.0F));
}

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
struct Change {
  LaneMap map = straight_road(2, 400.0F);
  scene::Scene scene;
  Parameters parameters;

  Change() {
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft);
  }
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
