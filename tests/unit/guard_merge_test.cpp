// Where the guard lets a plan merge, before or behind another, and what it asks of it there.
//
// A plan brakes in 0.35 s at the earliest, then with 6 m/s^2, which builds up in 0.15 s (guard_test.cpp). Places are those of the box centre, 2.5 m
// behind the front bumper.

#include <gtest/gtest.h>

#include "algo/safety/guard.hpp"
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

}  // namespace
}  // namespace s4tp::safety
