// What the guard makes of a licence: how long it holds, for whom, and when a stop in the zone is in order.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2 (guard_test.cpp). Places are those of the box centre, 2.5 m
// behind the front bumper.

#include <gtest/gtest.h>

#include "algo/safety/guard.hpp"
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

// We stand 0.7 m before the zone at 96, another so far before it, in sight of us (L2): we set off, and the scene is empty for what
// comes then.
void set_off_across(SharedGround& road, float its_way_m) {
  road.other(96.0F - its_way_m, 0.0F).stood_ms = 1000;
  road.scene.waited_s = 1.0F;
  const Verdict begun = road.judge(95.3F, 0.0F, 2.0F);
  ASSERT_TRUE(begun.safe() && begun.clears);
  road.guard.commit(0, begun);
  road.scene.agents.clear();
}

// GUARD-006 Both stand, it in sight of us (L2), and we set off. Then it does too, at 1 m/s 8 m before the zone
// (0.35 s at our speed, then the way of a stop with 6 m/s^2). At 95.4 and 0.4 m/s we can still stand at 95.91,
// before the zone at 96, speeding up until then: the licence is not used, and we do. At 95.4 and 1.6 m/s that would be 96.17: it holds.
TEST(Guard, ALicenceIsNotUsedBeforeWeAreBound) {
  for (const float speed_mps : {0.4F, 1.6F}) {
    SharedGround road(Priority::kFirstYields);
    set_off_across(road, 8.0F);
    road.other(96.0F - 8.0F, 3.0F);
    const Verdict now = road.judge(95.4F, speed_mps, 2.0F);
    EXPECT_TRUE(now.safe()) << speed_mps;
    EXPECT_EQ(now.clears, speed_mps > 1.0F) << speed_mps;
  }
}

// GUARD-001 The same, and it sets off, 14 m before the zone: it comes only after we were to be gone, no reason to stop in
// the zone. We can still stand at 95.7, before it (0.35 s at 0.9 m/s less 1.5 m/s^2, then the way of a stop), and may, though 0.7 m are
// kept else.
TEST(Guard, WhoSetOffMayUseUpTheRoomBeforeTheZone) {
  SharedGround road(Priority::kFirstYields);
  set_off_across(road, 14.0F);
  road.other(96.0F - 14.0F, 0.6F);
  const Verdict now = road.judge(95.5F, 0.9F, -1.5F);
  EXPECT_TRUE(now.safe());
  EXPECT_FALSE(now.clears);
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

// GUARD-006 A licence is used for all of a group at once, but for ground where the first comes: 40 m off at 6 m/s it can stop gently
// before the second of two zones; when the fail-safe stops at 97.1, in the first one, it is 8 m off. Bound to leave the second to us
// too, it does; where the first comes it is bound to nothing, and we stop short of it.
TEST(Guard, ALicenceIsUsedForAllOfItsGroup) {
  for (const Priority priority : {Priority::kFirstYields, Priority::kFirstCome}) {
    SharedGround road(Priority::kFirstYields);
    const scene::LanePath beside = add_second_zone(road, 104.5F, 110.0F);
    road.scene.ego_paths[0].zones[1].priority = priority;
    add_vehicle(road.scene, road.map, beside, 96.0F - 40.0F, 6.0F);
    const Verdict begun = road.judge(94.0F, 3.0F, 1.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    road.scene.agents.clear();
    add_vehicle(road.scene, road.map, beside, 96.0F - 8.0F, 6.0F);
    const Verdict verdict = road.judge(95.2F, 3.0F, 1.0F);
    EXPECT_TRUE(verdict.safe());
    EXPECT_EQ(verdict.stops_short, priority == Priority::kFirstCome);
  }
}

// GUARD-006 Going through with nobody about, the fail-safe unable to stop before the zone any more: one comes in sight that can be
// there after 1.9 s, and we are gone after 2.2. 18 m off at 8 m/s it finds the ground taken and can stop (8 + 8 m); at 12 m/s it
// cannot, nor is one that was there before bound.
TEST(Guard, WhoComesInSightFindsTheGroundTaken) {
  struct Case {
    float their_mps;
    std::uint16_t known_ms;
    bool passes;
  };
  for (const Case& one : {Case{8.0F, 0, true}, Case{12.0F, 0, false}, Case{8.0F, 500, false}}) {
    SharedGround road(Priority::kFirstYields);
    road.scene.time_ms = 10'000;
    road.guard.commit(0, road.judge(92.0F, 5.0F, 0.0F));
    road.scene.time_ms = 10'100;
    road.guard.commit(0, road.judge(92.5F, 5.0F, 0.0F));
    road.scene.time_ms = 10'200;
    road.other(96.0F - 18.0F, one.their_mps).known_ms = one.known_ms;
    EXPECT_EQ(road.safe(93.0F, 5.0F, 0.0F), one.passes) << one.their_mps << ' ' << one.known_ms;
    // Once we have come to a stand in the zone it is like anybody else: one that can stop for us may be stopped short of.
    EXPECT_EQ(road.judge(97.0F, 0.0F, 0.5F).stops_short, one.their_mps < 10.0F);
  }
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

// GUARD-006 GUARD-011 We set off before one that stands 8 m before the second zone (L2), and it does, too. At 95.4 and 1 m/s we
// can still stand at 95.8, before the first zone at 96 (0.35 s, then the way of a stop with 6 m/s^2): our licence is not used, and nobody
// stops in that zone, at 96.3, with 3 m/s^2 until then. At 1.6 m/s we are bound, and go on.
TEST(Guard, NobodyStopsShortInAGroupItCanStayOutOf) {
  for (const float speed_mps : {1.0F, 1.6F}) {
    SharedGround road(Priority::kFirstYields);
    const scene::LanePath beside = add_second_zone(road, 104.5F, 110.0F);
    add_vehicle(road.scene, road.map, beside, 96.0F - 8.0F, 0.0F).stood_ms = 1000;
    road.scene.waited_s = 1.0F;
    const Verdict begun = road.judge(95.3F, 0.0F, 2.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    road.scene.agents.clear();
    add_vehicle(road.scene, road.map, beside, 96.0F - 8.0F, 3.0F);
    const Verdict now = road.judge(95.4F, speed_mps, 3.0F);
    EXPECT_EQ(now.safe(), speed_mps > 1.0F) << speed_mps;
    EXPECT_FALSE(now.stops_short) << speed_mps;
    EXPECT_TRUE(road.safe(95.4F, 1.0F, 0.0F));
  }
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

// GUARD-011 Whoever is at the ground we would stand on has let us go: 40 m off at 6 m/s it could stop gently. 13 m off, gaining
// speed, it can stop for us all the same (5 + 3.1 m at 5 m/s). For one at the second zone who has not let us go we stand there;
// for nobody we do not.
TEST(Guard, StopsShortBeforeOneWhoHasLetUsGoOnlyForAnother) {
  for (const bool another : {true, false}) {
    SharedGround road(Priority::kFirstYields);
    const scene::LanePath beside = add_second_zone(road, 104.5F, 110.0F);
    road.other(96.0F - 40.0F, 6.0F);
    const Verdict begun = road.judge(94.0F, 6.0F, 0.0F);
    ASSERT_TRUE(begun.safe() && begun.clears);
    road.guard.commit(0, begun);
    road.scene.agents.clear();
    road.other(96.0F - 13.0F, 5.0F).track.acceleration_mps2 = 1.0F;
    if (another) add_vehicle(road.scene, road.map, beside, 96.0F - 4.0F, 8.0F);
    const Verdict verdict = road.judge(97.0F, 6.0F, 0.0F);
    EXPECT_TRUE(verdict.safe());
    EXPECT_EQ(verdict.stops_short, another);
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

}  // namespace
}  // namespace s4tp::safety
