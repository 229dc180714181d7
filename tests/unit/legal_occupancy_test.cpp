// When a vehicle that keeps to the law can be in a zone.

#include "algo/safety/legal_occupancy.hpp"

#include <gtest/gtest.h>

#include "tests/support/shared_ground.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// The crossing's other vehicle, `to_entry_m` before the zone of 8 m, as the law sees it. It has been in
/// sight for long.
struct Approach : SharedGround {
  explicit Approach(Priority priority, float to_entry_m, float speed_mps) : SharedGround(priority) {
    other(96.0F - to_entry_m, speed_mps);
    agent().known_ms = 5000;
  }
  scene::Agent& agent() { return scene.agents[0]; }
  [[nodiscard]] ZoneOccupancy when(float lead_s = 0.0F) const {
    occupancy::LaneReach reach;
    reach.measure(map, scene.agents[0]);
    return zone_occupancy(scene, scene.agents[0], reach, scene.ego_paths[0].zones[0], lead_s, parameters);
  }
  [[nodiscard]] Claim claim() const { return when().claim; }
};

// LEGAL-001 40 m before the zone at 9.28 m/s it gains 2 m/s^2 for 3 s to 1.1 * 13.89 = 15.28 m/s: 36.84 m,
// and the last 3.16 m take 0.21 s. Braking with 8 m/s^2 it stands after 5.4 m: it need not ever leave.
TEST(LegalOccupancy, FromTheFastestToTheSlowest) {
  const Approach approach(Priority::kFirstYields, 40.0F, 9.279F);
  const ZoneOccupancy when = approach.when();
  EXPECT_EQ(when.claim, Claim::kMayCome);
  EXPECT_NEAR(when.from_s, 3.207F, 0.005F);
  EXPECT_EQ(when.until_s, occupancy::kNeverS);
  EXPECT_NEAR(when.to_entry_m, 40.0F, 0.01F);
  EXPECT_NEAR(when.to_exit_m, 48.0F, 0.01F);
}

// LEGAL-001 Who gains 3 m/s^2 may go on doing so: 24.56 m in 2 s, and 15.44 m at 15.28 m/s take 1.01 s. That it
// brakes is not counted on.
TEST(LegalOccupancy, WhoGainsFasterThanTheLawIsTakenAtItsWord) {
  Approach approach(Priority::kFirstYields, 40.0F, 9.279F);
  approach.agent().track.acceleration_mps2 = 3.0F;
  EXPECT_NEAR(approach.when().from_s, 3.011F, 0.005F);
  approach.agent().track.acceleration_mps2 = -3.0F;
  EXPECT_NEAR(approach.when().from_s, 3.207F, 0.005F);
}

// LEGAL-001 2 m before its exit at 12 m/s it stops in no less than 9 m: it is out after at most (12 -
// sqrt(144 - 32)) / 8 = 0.177 s. Plans that begin 0.1 s later count from there.
TEST(LegalOccupancy, WhoCannotStopLeavesTheZone) {
  const Approach inside(Priority::kFirstYields, -6.0F, 12.0F);
  EXPECT_EQ(inside.claim(), Claim::kMayCome);
  EXPECT_NEAR(inside.when().until_s, 0.177F, 0.002F);
  EXPECT_EQ(inside.when().from_s, 0.0F);
  EXPECT_NEAR(inside.when(0.1F).until_s, 0.077F, 0.002F);
  EXPECT_NEAR(inside.when(0.1F).from_s, -0.1F, 1e-6F);
}

// LEGAL-001 Past the zone, or with no way into its lane, nobody is expected.
TEST(LegalOccupancy, WhoIsGoneOrElsewhereHasNoClaim) {
  EXPECT_EQ(Approach(Priority::kFirstYields, -8.1F, 5.0F).claim(), Claim::kNone);
  EXPECT_NE(Approach(Priority::kFirstYields, -7.9F, 5.0F).claim(), Claim::kNone);
  Approach elsewhere(Priority::kFirstYields, 20.0F, 5.0F);
  elsewhere.scene.agents.clear();
  add_vehicle(elsewhere.scene, elsewhere.map, elsewhere.ours, 150.0F, 5.0F);
  EXPECT_EQ(elsewhere.claim(), Claim::kNone);
}

// LEGAL-001 Zones are made for cars of 5 m: one of 12 m is in it 3.5 m sooner and leaves 3.5 m later.
TEST(LegalOccupancy, LongerVehiclesComeSoonerAndLeaveLater) {
  Approach lorry(Priority::kFirstYields, 20.0F, 5.0F);
  lorry.agent().track.length_m = 12.0F;
  EXPECT_NEAR(lorry.when().to_entry_m, 16.5F, 0.01F);
  EXPECT_NEAR(lorry.when().to_exit_m, 31.5F, 0.01F);
  Approach leaving(Priority::kFirstYields, -11.0F, 5.0F);
  leaving.agent().track.length_m = 12.0F;
  EXPECT_EQ(leaving.claim(), Claim::kMayCome);
}

// LEGAL-002 D1: it owes us the way and stops from 8 m/s with 4 m/s^2 within 8 m. New in sight it goes on for
// 1 s first, 16 m in all; after 0.5 s of being seen 12 m; after 1 s or more 8 m: the response runs once.
TEST(LegalOccupancy, WhoOwesUsTheWayStopsAfterOneResponse) {
  const struct {
    std::uint16_t known_ms;
    float enough_m;
  } cases[] = {{0, 16.1F}, {500, 12.1F}, {1000, 8.1F}, {60000, 8.1F}};
  for (const auto& seen : cases) {
    Approach can(Priority::kFirstHasPriority, seen.enough_m, 8.0F);
    can.agent().known_ms = seen.known_ms;
    EXPECT_EQ(can.claim(), Claim::kOwes) << seen.known_ms;
    Approach cannot(Priority::kFirstHasPriority, seen.enough_m - 0.2F, 8.0F);
    cannot.agent().known_ms = seen.known_ms;
    EXPECT_EQ(cannot.claim(), Claim::kMayCome) << seen.known_ms;
  }
}

// LEGAL-002 What is owed before the zone is not owed any more by one inside it.
TEST(LegalOccupancy, InsideNobodyGivesWay) {
  EXPECT_EQ(Approach(Priority::kFirstHasPriority, -1.0F, 2.0F).claim(), Claim::kMayCome);
}

// LEGAL-003 L1: at the top speed of 15.28 m/s 1.5 s are 22.9 m, braking with 2 m/s^2 takes 58.4 m, and it
// stops 0.5 m before: 81.8 m. From 6 m/s gaining to 9 m/s 11.25 + 20.25 + 0.5 = 32 m. First come is asked the
// same.
TEST(LegalOccupancy, WhoCanStopGentlyMayBeAsked) {
  for (const Priority priority : {Priority::kFirstYields, Priority::kFirstCome}) {
    EXPECT_EQ(Approach(priority, 82.0F, 15.279F).claim(), Claim::kCanStop);
    EXPECT_EQ(Approach(priority, 81.5F, 15.279F).claim(), Claim::kMayCome);
    EXPECT_EQ(Approach(priority, 32.1F, 6.0F).claim(), Claim::kCanStop);
    EXPECT_EQ(Approach(priority, 31.9F, 6.0F).claim(), Claim::kMayCome);
  }
}

// LEGAL-002 D2: for who is there by right it stops from 8 m/s within 16 m, a whole response counted, however
// long it has been in sight: that we would come in it did not know.
TEST(LegalOccupancy, AStopForWhoIsThereTakesAWholeResponse) {
  EXPECT_TRUE(Approach(Priority::kFirstYields, 16.1F, 8.0F).when().can_stop);
  EXPECT_FALSE(Approach(Priority::kFirstYields, 15.9F, 8.0F).when().can_stop);
}

// LEGAL-003 Who gains speed does not leave it to us, far as it may be.
TEST(LegalOccupancy, WhoGainsSpeedIsNotAsked) {
  for (const float gain_mps2 : {-1.0F, 0.4F, 0.6F}) {
    Approach approach(Priority::kFirstYields, 35.0F, 6.0F);
    approach.agent().track.acceleration_mps2 = gain_mps2;
    EXPECT_EQ(approach.claim(), gain_mps2 < 0.5F ? Claim::kCanStop : Claim::kMayCome) << gain_mps2;
  }
}

// LEGAL-003 No licence asks who is in the zone to stop.
TEST(LegalOccupancy, InsideNobodyIsAskedToStop) {
  EXPECT_EQ(Approach(Priority::kFirstYields, -0.1F, 0.5F).claim(), Claim::kMayCome);
}

// LEGAL-004 L2: 3 m before the zone it has stood for 0.7 s and we have stood as long: it may be passed in
// front of. Not a moment sooner, not when it rolls, and not when it sets off.
TEST(LegalOccupancy, WhoStandsInSightMayBePassed) {
  const auto standing = [](std::uint16_t stood_ms, float waited_s, float speed_mps, float acceleration_mps2) {
    Approach approach(Priority::kFirstYields, 3.0F, speed_mps);
    approach.agent().stood_ms = stood_ms;
    approach.agent().track.acceleration_mps2 = acceleration_mps2;
    approach.scene.waited_s = waited_s;
    return approach.claim();
  };
  EXPECT_EQ(standing(700, 0.7F, 0.0F, 0.0F), Claim::kStands);
  EXPECT_EQ(standing(600, 0.7F, 0.0F, 0.0F), Claim::kMayCome);
  EXPECT_EQ(standing(700, 0.6F, 0.0F, 0.0F), Claim::kMayCome);
  EXPECT_EQ(standing(700, 0.7F, 0.5F, 0.0F), Claim::kMayCome);
  EXPECT_EQ(standing(700, 0.7F, 0.1F, 1.0F), Claim::kMayCome);
}

// LEGAL-004 One that stands in the zone of 8 m is an obstacle where it stands, and may go on into our way (drives entered before one
// that stood 0.2 m in, and set off), until all have stood for 2 s: else one that waits for us as we for it stands there for ever.
// Where lanes merge its way on is ours: drives set off beside one that did a second later.
TEST(LegalOccupancy, WhoStandsInTheZoneIsAnObstacle) {
  const auto standing = [](float entry_m, std::uint16_t stood_ms, float waited_s, bool merging = false) {
    Approach approach(Priority::kFirstYields, entry_m, 0.0F);
    approach.zone().merging = merging;
    approach.agent().stood_ms = stood_ms;
    approach.scene.waited_s = waited_s;
    const Claim claim = approach.claim();
    approach.agent().track.acceleration_mps2 = 1.0F;
    EXPECT_EQ(approach.claim(), Claim::kMayCome) << "sets off";
    return claim;
  };
  for (const float entry_m : {-1.0F, -6.0F}) {
    EXPECT_EQ(standing(entry_m, 60'000, 1.9F), Claim::kMayCome);
    EXPECT_EQ(standing(entry_m, 1900, 60.0F), Claim::kMayCome);
    EXPECT_EQ(standing(entry_m, 2000, 2.0F), Claim::kStands);
    EXPECT_EQ(standing(entry_m, 60'000, 60.0F, true), Claim::kMayCome);
  }
}

// LEGAL-006 Beside our way nobody expects us: not who has stood there as long as a licence takes (0.7 s), nor who could stop. Once all
// have stood for 2 s any one may go past one that stands short of there: else we and one that waits for us stand there for ever.
TEST(LegalOccupancy, WhoIsBesideOurWayLeavesNothingToUs) {
  for (const float to_entry_m : {-1.0F, 5.0F, 60.0F}) {
    for (const Priority priority : {Priority::kFirstYields, Priority::kFirstHasPriority}) {
      const bool drives = to_entry_m > 50.0F;
      Approach approach(priority, to_entry_m, drives ? 5.0F : 0.0F);
      approach.agent().stood_ms = 1900;
      approach.scene.waited_s = 60.0F;
      if (to_entry_m > 0.0F) {
        EXPECT_NE(approach.claim(), Claim::kMayCome);
      }
      approach.zone().beside = true;
      EXPECT_EQ(approach.claim(), Claim::kMayCome);
      EXPECT_FALSE(approach.when().can_stop);
      approach.agent().stood_ms = 2000;
      EXPECT_EQ(approach.claim(), drives || to_entry_m < 0.0F ? Claim::kMayCome : Claim::kStands);
      approach.agent().track.acceleration_mps2 = 1.0F;
      EXPECT_EQ(approach.claim(), Claim::kMayCome) << "sets off";
    }
  }
}

// LEGAL-004 So does one that owes us the way; but who drives up to it may see it move on and clear the zone.
TEST(LegalOccupancy, WhoOwesUsTheWayAndStandsInTheZoneIsAnObstacle) {
  Approach approach(Priority::kFirstHasPriority, -1.0F, 0.0F);
  approach.agent().stood_ms = 2000;
  EXPECT_EQ(approach.claim(), Claim::kMayCome);
  approach.scene.waited_s = 2.0F;
  EXPECT_EQ(approach.claim(), Claim::kStands);
}

// LEGAL-001 A quarter turn of 15.1 m in 11 chords turns by 10 / 11 of it from the first to the last: 10.6 m
// of radius, driven with at most sqrt(7 * 10.6) = 8.6 m/s. At 13 m/s 10 m before the bend, the zone 8 m into
// it: without the bend there after 1.27 s, with it after 10 m (0.73 s) and 8 m at 8.6 m/s (0.93 s).
TEST(LegalOccupancy, BendsAreDrivenAsFastAsTheyAllow) {
  for (const bool bend : {false, true}) {
    LaneMap map;
    const LaneIndex before = add_lane(map, {{-50.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex turn = bend ? add_lane(map, arc({0.0F, 0.0F, 0.0F}, 9.6F, 1.5707963F, kMaxLanePoints))
                                : add_lane(map, {{0.0F, 0.0F}, {7.5F, 0.0F}, {15.08F, 0.0F}});
    link(map, before, turn);
    scene::Scene scene;
    scene.map = &map;
    const scene::Agent& agent = add_vehicle(scene, map, path_of(map, {before, turn}), 40.0F, 13.0F);
    scene::ConflictZone zone;
    zone.other_lane = turn;
    zone.other_entry_m = 8.0F;
    zone.other_exit_m = 14.0F;
    zone.priority = Priority::kFirstYields;
    occupancy::LaneReach reach;
    reach.measure(map, agent);
    const ZoneOccupancy when = zone_occupancy(scene, agent, reach, zone, 0.0F, Parameters{});
    EXPECT_NEAR(when.from_s, bend ? 1.66F : 1.27F, 0.02F);
  }
}

// LEGAL-005 Not seen for 0.4 s and taken to have driven 4 m at 10 m/s meanwhile, a vehicle is as near as by the law
// since its last sight: the same bits as seen then, with a plan that begins 0.4 s later.
TEST(LegalOccupancy, CountsFromTheLastSight) {
  for (const float to_entry_m : {12.0F, 30.0F, 60.0F, -2.0F}) {
    const Approach then(Priority::kFirstYields, to_entry_m, 10.0F);
    Approach now(Priority::kFirstYields, to_entry_m - 4.0F, 10.0F);
    now.agent().age_ms = 400;
    now.agent().coasted_m = 4.0F;
    if (to_entry_m > 4.0F) {
      EXPECT_NEAR(now.when().from_s, then.when(0.4F).from_s, 1e-3F) << to_entry_m;
    }
    EXPECT_NEAR(now.when().until_s, then.when(0.4F).until_s, 1e-3F) << to_entry_m;
  }
}

// LEGAL-005 Taken to brake from 10 to 8 m/s, it may as well have gained 2 m/s^2: it is counted on at 10.
TEST(LegalOccupancy, WhatItWasTakenToDoIsNotCountedOn) {
  const Approach then(Priority::kFirstYields, 30.0F, 10.0F);
  Approach now(Priority::kFirstYields, 26.4F, 8.0F);
  now.agent().age_ms = 400;
  now.agent().coasted_m = 3.6F;
  now.agent().coasted_mps = -2.0F;
  EXPECT_NEAR(now.when().from_s, then.when(0.4F).from_s, 1e-3F);
}

// LEGAL-004, LEGAL-005 Who stood at the last sight may have set off since: after 250 ms it is not passed any more.
TEST(LegalOccupancy, WhoIsNotSeenMayHaveSetOff) {
  Approach approach(Priority::kFirstYields, 1.0F, 0.0F);
  approach.agent().stood_ms = 5000;
  approach.scene.waited_s = 5.0F;
  approach.agent().age_ms = 200;
  EXPECT_EQ(approach.claim(), Claim::kStands);
  approach.agent().age_ms = 300;
  EXPECT_EQ(approach.claim(), Claim::kMayCome);
}

}  // namespace
}  // namespace s4tp::safety
