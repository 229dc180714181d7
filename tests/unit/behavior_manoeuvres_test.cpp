// Manoeuvres as they are driven: what a plan taken, and where we are, make of the state.

#include <gtest/gtest.h>

#include "algo/behavior/manoeuvres.hpp"
#include "algo/core/standing.hpp"
#include "tests/support/lane_change_road.hpp"
#include "tests/support/planner_drive.hpp"

namespace s4tp::behavior {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Two lanes, 3.2 m wide; our box is 5.0 x 1.8 m.
struct Change {
  LaneChangeRoad road;
  ManoeuvreState state;

  /// We are `d_m` left of the centre of the lane under us and `heading_rad` across; the plan taken follows path `path`.
  void take(float d_m, int path, float heading_rad = 0.0F) {
    TrajectoryPoint own = state_on(road.map, road.scene.ego_paths[0].path, 50.0F, 10.0F, d_m);
    own.rear_axle.heading_rad = heading_rad;
    put_ego(road.scene, own);
    const Trajectory trajectory = across(own, 0.0F, 0.0F);
    pass_time(100, state);
    advance({path, &trajectory}, road.scene, road.parameters, state);
  }
  /// The left lane is under us, the right one beside.
  void come_over() {
    road.scene.ego_paths.clear();
    add_ego_path(road.scene, road.map, path_of(road.map, {1}));
    add_ego_path(road.scene, road.map, path_of(road.map, {0}), scene::Manoeuvre::kRight);
  }
};

// BEHAV-002: with 0.7 m to the line on each side our box is over it 0.8 m beside the centre, half over when the other lane
// is under us, inside that 0.7 m short of its centre, and settled 2 s later.
TEST(LaneChangeState, FromKeepToKeep) {
  Change change;
  change.take(0.0F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kKeep);
  EXPECT_EQ(change.state.side, 0);
  change.take(0.6F, 1);
  EXPECT_EQ(change.state.lane_change, LaneChange::kPrepare);
  EXPECT_EQ(change.state.side, 1);
  EXPECT_EQ(change.state.lane_change_ms, 0);
  change.take(0.6F, 1);
  EXPECT_EQ(change.state.lane_change_ms, 100);
  change.take(0.8F, 1);
  EXPECT_EQ(change.state.lane_change, LaneChange::kCrossing);
  EXPECT_EQ(leads_to(change.state, change.road.scene), 1);
  change.come_over();
  change.take(-1.5F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kFinish);
  EXPECT_EQ(leads_to(change.state, change.road.scene), 0);
  change.take(-0.8F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kFinish);
  change.take(-0.6F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kSettle);
  for (int i = 0; i < 20; ++i) change.take(-0.6F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kSettle);
  change.take(0.0F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kKeep);
  EXPECT_EQ(change.state.side, 0);
}

// BEHAV-002: turned by 0.2 rad a corner is over the line already; turned away, too, but not on the side it leads to.
TEST(LaneChangeState, TheCornersCount) {
  Change change;
  change.take(0.2F, 1, 0.2F);
  EXPECT_EQ(change.state.lane_change, LaneChange::kCrossing);
}

// BEHAV-002: before the line it is dropped, beyond it given up: others get used to us before it is over.
TEST(LaneChangeState, DroppedOrGivenUp) {
  Change change;
  change.take(0.3F, 1);
  change.take(0.4F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kKeep);
  change.take(0.9F, 1);
  EXPECT_EQ(change.state.lane_change, LaneChange::kCrossing);
  change.take(0.9F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kSettle);
  EXPECT_EQ(leads_to(change.state, change.road.scene), 0);
  change.take(0.9F, 1);
  EXPECT_EQ(change.state.lane_change, LaneChange::kCrossing);
}

// BEHAV-002: a plan that leads to the other side turns it: another decision, with a time of its own.
TEST(LaneChangeState, Turned) {
  Change change;
  change.road.map = straight_road(3, 400.0F);
  change.road.scene.ego_paths.clear();
  add_ego_path(change.road.scene, change.road.map, path_of(change.road.map, {1}));
  add_ego_path(change.road.scene, change.road.map, path_of(change.road.map, {2}), scene::Manoeuvre::kLeft);
  add_ego_path(change.road.scene, change.road.map, path_of(change.road.map, {0}), scene::Manoeuvre::kRight);
  change.take(0.0F, 1);
  change.take(0.0F, 1);
  EXPECT_EQ(change.state.lane_change_ms, 100);
  change.take(0.0F, 2);
  EXPECT_EQ(change.state.lane_change, LaneChange::kPrepare);
  EXPECT_EQ(change.state.side, -1);
  EXPECT_EQ(change.state.lane_change_ms, 0);
  EXPECT_EQ(leads_to(change.state, change.road.scene), 2);
}

// BEHAV-002: half over the old lane may still be taken again, as another change; so may one that has just settled.
TEST(LaneChangeState, BackFromOverHalf) {
  Change change;
  change.take(0.9F, 1);
  change.come_over();
  change.take(-1.2F, 0);
  EXPECT_EQ(change.state.lane_change, LaneChange::kFinish);
  change.take(-1.2F, 1);
  EXPECT_EQ(change.state.lane_change, LaneChange::kCrossing);
  EXPECT_EQ(change.state.side, -1);
}

// BEHAV-002: where no lane lies beside any more, or none at all is known, no change goes on.
TEST(LaneChangeState, NoLaneToGoOnTo) {
  Change change;
  change.take(0.3F, 1);
  change.road.scene.ego_paths.truncate(1);
  EXPECT_EQ(leads_to(change.state, change.road.scene), 0);
  change.road.scene.ego_paths.clear();
  EXPECT_EQ(leads_to(change.state, change.road.scene), 0);
}

/// We drive at 10 m/s with a group of two zones 20 m ahead.
struct Crossing {
  LaneMap map = straight_road(1, 400.0F);
  scene::Scene scene;
  Parameters parameters;
  ManoeuvreState state;

  Crossing() {
    scene::EgoPath& path = add_ego_path(scene, map, path_of(map, {0}));
    scene::ConflictZone zone;
    zone.entry_s_m = 70.0F;
    zone.exit_s_m = 74.0F;
    zone.other_lane = 7;
    (void)path.zones.push(zone);
    zone.other_lane = 8;
    (void)path.zones.push(zone);
    put_ego(scene, state_on(map, path.path, 50.0F, 10.0F));
  }
  void take(float speed_mps, bool passes, int passed_zones = 0) {
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points) point.speed_mps = speed_mps;
    pass_time(100, state);
    advance({0, &trajectory, passes, passed_zones}, scene, parameters, state);
  }
};

// BEHAV-003: our centre is at 51.5 m: at 6 m/s it comes to 69.5 m and stays out, at 10 m/s it leads in.
TEST(ZoneClaimState, FromConsideredToCleared) {
  Crossing crossing;
  crossing.take(6.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kConsidered);
  crossing.take(10.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kClaimed);
  EXPECT_EQ(crossing.state.zone_lane, 7);
  EXPECT_EQ(crossing.state.zone_claim_ms, 0);
  crossing.take(10.0F, true, 2);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kCommitted);
  EXPECT_EQ(crossing.state.zone_lane, 8);
  crossing.scene.ego_paths[0].zones.clear();
  crossing.take(10.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kCleared);
  crossing.take(10.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kConsidered);
}

// BEHAV-003: withdrawn when the plan stays out; after 3 s of leading in, too; and when a fail-safe stops before it again.
TEST(ZoneClaimState, Withdrawn) {
  Crossing crossing;
  crossing.take(10.0F, false);
  crossing.take(6.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kWithdrawn);
  crossing.take(6.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kConsidered);
  for (int i = 0; i < 30; ++i) crossing.take(10.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kClaimed);
  crossing.take(10.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kWithdrawn);
  crossing.take(10.0F, true, 3);  // no path has so many
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kCommitted);
  EXPECT_EQ(crossing.state.zone_lane, 7);
  crossing.take(6.0F, false);
  EXPECT_EQ(crossing.state.zone_claim, ZoneClaim::kWithdrawn);
}

// The lane ends 40 m ahead and has to be left: 30 m further, with 3.5 m less than a change takes, we wait when we stand.
TEST(RequiredChangeState, ApproachesWaitsAndIsOver) {
  LaneChangeRoad road;
  Trajectory trajectory;
  ManoeuvreState state;
  scene::EgoPath& own = road.scene.ego_paths[0];
  need_changes(own, 1, 94.0F);
  const auto take = [&](float s_m, float speed_mps) {
    put_ego(road.scene, state_on(road.map, own.path, s_m, speed_mps));
    pass_time(100, state);
    advance({0, &trajectory}, road.scene, road.parameters, state);
    return state.required_change;
  };
  EXPECT_EQ(take(50.0F, 0.0F), RequiredChange::kApproaching);
  EXPECT_EQ(state.required_change_ms, 0);
  EXPECT_EQ(take(50.0F, 0.0F), RequiredChange::kApproaching);
  EXPECT_EQ(state.required_change_ms, 100);
  EXPECT_EQ(take(80.0F, 1.0F), RequiredChange::kApproaching);
  EXPECT_EQ(take(80.0F, 0.0F), RequiredChange::kWaiting);
  EXPECT_EQ(take(80.0F, 0.0F), RequiredChange::kWaiting);
  EXPECT_EQ(take(80.0F, kStandingMps), RequiredChange::kApproaching);
  EXPECT_EQ(take(80.0F, 0.0F), RequiredChange::kWaiting);
  need_changes(own, 0, 94.0F);
  EXPECT_EQ(take(80.0F, 0.0F), RequiredChange::kNone);
}

// BEHAV-001: where nothing that was proposed is taken, the plan put out carries the state of the one in force.
TEST(ManoeuvreState, StaysWhenNoPlanIsTaken) {
  PlannerDrive drive = on_straight_road(10.0F);
  ASSERT_EQ(drive.step(), Status::kOk);
  drive.running.manoeuvre = {
      LaneChange::kPrepare, 1, RequiredChange::kApproaching, ZoneClaim::kClaimed, 1, 2, 3, 4};
  drive.planner->allowance.candidates = 0;
  ASSERT_EQ(drive.step(), Status::kNoSafePlan);
  EXPECT_EQ(drive.running.kind, PlanKind::kMinimumRisk);
  const ManoeuvreState& state = drive.running.manoeuvre;
  EXPECT_EQ(state.lane_change, LaneChange::kPrepare);
  EXPECT_EQ(state.side, 1);
  EXPECT_EQ(state.required_change, RequiredChange::kApproaching);
  EXPECT_EQ(state.zone_claim, ZoneClaim::kClaimed);
  EXPECT_EQ(state.lane_change_ms, 101);
  EXPECT_EQ(state.zone_lane, 4);
}

// CORE-078: what has been so for a minute has been so for at least that.
TEST(ManoeuvreState, AMinuteIsTheLongest) {
  ManoeuvreState state;
  state.zone_claim_ms = 100;
  pass_time(59'950, state);
  EXPECT_EQ(state.lane_change_ms, 59'950);
  EXPECT_EQ(state.zone_claim_ms, 60'000);
  pass_time(-100, state);
  EXPECT_EQ(state.lane_change_ms, 59'950);
  pass_time(0x7FFFFFFF, state);
  EXPECT_EQ(state.required_change_ms, 60'000);
}

// CORE-014 CORE-078: a state that is none of ours makes the running plan none of ours.
TEST(ManoeuvreState, OneThatIsNoneOfOurs) {
  for (const ManoeuvreState& bad :
       {ManoeuvreState{static_cast<LaneChange>(5)}, ManoeuvreState{LaneChange::kKeep, 2},
        ManoeuvreState{LaneChange::kKeep, -2},
        ManoeuvreState{LaneChange::kKeep, 0, static_cast<RequiredChange>(3)},
        ManoeuvreState{LaneChange::kKeep, 0, RequiredChange::kNone, static_cast<ZoneClaim>(5)}}) {
    PlannerDrive drive = on_straight_road(10.0F);
    ASSERT_EQ(drive.step(), Status::kOk);
    drive.running.manoeuvre = bad;
    EXPECT_EQ(drive.step(), Status::kInvalidInput);
    EXPECT_TRUE(is_known(drive.running.manoeuvre));
  }
}

}  // namespace
}  // namespace s4tp::behavior
