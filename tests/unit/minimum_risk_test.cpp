// The minimum-risk manoeuvre.

#include "algo/safety/minimum_risk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr std::uint32_t kNow = 5000;

Trajectory manoeuvre(const Scene& scene, const TrajectoryPoint& start, const Plan& running = {}) {
  Trajectory trajectory;
  minimum_risk(scene, start, running, kNow, Parameters{}, trajectory);
  return trajectory;
}

float hardest(const Trajectory& trajectory) {
  float least = 0.0F;
  for (const TrajectoryPoint& point : trajectory.points) least = std::fmin(least, point.acceleration_mps2);
  return least;
}

const TrajectoryPoint& end_of(const Trajectory& trajectory) {
  return trajectory.points[kHorizonSteps];
}

struct Road {
  LaneMap map = straight_road(1, 300.0F);
  Scene scene;
  Road() { add_way(scene, map, path_of(map, {0})); }
  TrajectoryPoint at(float s_m, float speed_mps) {
    const TrajectoryPoint start = state_on(map, scene.ego_paths[0].path, s_m, speed_mps);
    put_ego(scene, start);
    return start;
  }
  ConflictZone& zone(float entry_s_m, float exit_s_m) {
    ConflictZone zone;
    zone.entry_s_m = entry_s_m;
    zone.exit_s_m = exit_s_m;
    zone.stop_s_m = entry_s_m + 1.5F;
    zone.other_lane = 0;
    EgoPath& way = scene.ego_paths[0];
    (void)way.zones.push(zone);
    return way.zones[way.zones.size() - 1];
  }
};

// MRM-001 From 10 m/s with 4 m/s^2: at rest in the lane, after 100 / 8 = 12.5 m and what the brake takes to
// build up.
TEST(MinimumRisk, BrakesToAStopInItsLane) {
  Road road;
  TrajectoryPoint start = road.at(50.0F, 10.0F);
  start.rear_axle.y_m = 0.4F;
  const Trajectory trajectory = manoeuvre(road.scene, start);
  EXPECT_EQ(end_of(trajectory).speed_mps, 0.0F);
  EXPECT_NEAR(end_of(trajectory).rear_axle.x_m, 63.0F, 0.7F);
  EXPECT_LT(std::fabs(end_of(trajectory).rear_axle.y_m), 0.2F);
  EXPECT_NEAR(hardest(trajectory), -4.0F, 1e-4F);
  EXPECT_TRUE(feasible(trajectory, Parameters{}));
}

// MRM-001 Without a map, along the running plan: a curve of radius 20 m to the left stays one.
TEST(MinimumRisk, FollowsTheRunningPlanWithoutAMap) {
  Plan running;
  running.kind = PlanKind::kDrive;
  running.start_ms = kNow - 200;
  running.trajectory.points[0].speed_mps = 6.0F;
  running.trajectory.points[0].curvature_1pm = 0.05F;
  for (int i = 1; i < kTrajectoryPoints; ++i)
    running.trajectory.points[i] = bicycle_step(running.trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
  const TrajectoryPoint start = sample(running, kNow);
  const Trajectory trajectory = manoeuvre(Scene{}, start, running);
  EXPECT_EQ(end_of(trajectory).speed_mps, 0.0F);
  for (const TrajectoryPoint& point : trajectory.points)
    EXPECT_NEAR(std::hypot(point.rear_axle.x_m, point.rear_axle.y_m - 20.0F), 20.0F, 0.02F);
}

// MRM-002 A car stands 10 m ahead of our front: to stop 1 m before it from 10 m/s takes 100 / 18 = 5.6 m/s^2,
// or 6.25 with the metre of build-up, and the manoeuvre does stop before it.
TEST(MinimumRisk, BrakesHarderForALeader) {
  Road road;
  const TrajectoryPoint start = road.at(50.0F, 10.0F);
  add_vehicle(road.scene, road.map, road.scene.ego_paths[0].path, 54.0F + 10.0F + 2.5F, 0.0F);
  const Trajectory trajectory = manoeuvre(road.scene, start);
  EXPECT_LT(end_of(trajectory).rear_axle.x_m + 4.0F, 64.0F);
  EXPECT_NEAR(hardest(trajectory), -6.25F, 0.05F);
}

// MRM-002 Without a lane, whoever stands straight ahead counts too; who stands beside does not.
TEST(MinimumRisk, BrakesHarderForWhoIsAheadWithoutAMap) {
  Scene scene;
  Agent agent;
  agent.track.length_m = 5.0F;
  agent.track.width_m = 1.8F;
  agent.track.centre = {4.0F + 10.0F + 2.5F, 0.5F, 0.0F};
  (void)scene.agents.push(agent);
  TrajectoryPoint start;
  start.speed_mps = 10.0F;
  EXPECT_NEAR(hardest(manoeuvre(scene, start)), -6.25F, 0.05F);
  scene.agents[0].track.centre.y_m = 3.0F;
  EXPECT_NEAR(hardest(manoeuvre(scene, start)), -4.0F, 1e-4F);
}

// MRM-002 The road ends 15 m ahead of the rear axle, 11 m of the front: 1 m short of it takes 100 / 20 = 5
// m/s^2.
TEST(MinimumRisk, BrakesHarderBeforeTheEndOfTheRoad) {
  Road road;
  road.map.lanes[0].on_route = false;
  const Trajectory trajectory = manoeuvre(road.scene, road.at(285.0F, 10.0F));
  EXPECT_LT(end_of(trajectory).rear_axle.x_m + 4.0F, 300.0F);
}

// MRM-003 Braking with 4 from 10 m/s would end in a zone that the box centre enters after 11.5 m: with 100 /
// 22 = 4.5 m/s^2 (5 with build-up) it ends half a metre before. A zone entered after 5 m (11 m/s^2) cannot be
// helped.
TEST(MinimumRisk, StopsBeforeAZoneRatherThanInIt) {
  Road road;
  TrajectoryPoint start = road.at(50.0F, 10.0F);
  ConflictZone& zone = road.zone(51.5F + 11.5F, 75.0F);
  const Trajectory trajectory = manoeuvre(road.scene, start);
  EXPECT_LT(end_of(trajectory).rear_axle.x_m + 1.5F, zone.entry_s_m);
  EXPECT_LT(hardest(trajectory), -4.4F);
  zone.entry_s_m = 51.5F + 5.0F;
  EXPECT_NEAR(hardest(manoeuvre(road.scene, start)), -4.0F, 1e-4F);
}

// MRM-004 Standing in a zone that ends 3 m ahead of the box centre: drive out of it and stop; unless a car
// stands in the way, 2 m ahead.
TEST(MinimumRisk, LeavesAZoneWhenItsWayIsFree) {
  Road road;
  TrajectoryPoint state = road.at(50.0F, 0.0F);
  road.zone(45.0F, 54.5F);
  const TrajectoryPoint start = state;
  for (int i = 0; i < 80; ++i) {
    put_ego(road.scene, state);
    state = manoeuvre(road.scene, state).points[1];
  }
  EXPECT_EQ(state.speed_mps, 0.0F);
  EXPECT_GT(state.rear_axle.x_m + 1.5F, 54.5F);
  EXPECT_LT(state.rear_axle.x_m + 1.5F, 56.5F);
  put_ego(road.scene, start);
  add_vehicle(road.scene, road.map, road.scene.ego_paths[0].path, 54.0F + 2.0F + 2.5F, 0.0F);
  EXPECT_EQ(end_of(manoeuvre(road.scene, start)).rear_axle.x_m, start.rear_axle.x_m);
}

// MRM-004 The same with only the front in the zone, and somebody 20 m from it at 12 m/s, there in 1.7 s:
// stay. When he is 60 m away (5 s; leaving takes sqrt(2 * 9.5 / 2) = 3.1 s): go.
TEST(MinimumRisk, StaysWhenSomebodyComes) {
  for (const float to_entry_m : {20.0F, 60.0F}) {
    Road road;
    const TrajectoryPoint start = road.at(50.0F, 0.0F);
    const LaneIndex other = add_lane(road.map, {{55.0F, -100.0F}, {55.0F, 100.0F}});
    ConflictZone& zone = road.zone(51.0F, 60.5F);
    zone.priority = Priority::kFirstYields;
    zone.other_lane = other;
    zone.other_entry_m = 96.0F;
    zone.other_exit_m = 104.0F;
    add_vehicle(road.scene, road.map, path_of(road.map, {other}), 96.0F - to_entry_m, 12.0F);
    EXPECT_EQ(end_of(manoeuvre(road.scene, start)).speed_mps > 1.0F, to_entry_m > 40.0F) << to_entry_m;
  }
}

/// Two lanes along +x, we 1.5 m to the left of the right one's centre, heading for the left one; others
/// behind us, from bumper to bumper.
struct Astride {
  LaneMap map = straight_road(2, 300.0F);
  Scene scene;
  TrajectoryPoint start;
  explicit Astride(float speed_mps) {
    add_way(scene, map, path_of(map, {0}));
    add_way(scene, map, path_of(map, {1}), Manoeuvre::kLeft);
    start = state_on(map, scene.ego_paths[0].path, 100.0F, speed_mps, 1.5F);
    start.rear_axle.heading_rad = 0.1F;
    put_ego(scene, start);
  }
  void behind(int lane, float gap_m, float speed_mps) {
    add_vehicle(scene, map, scene.ego_paths[lane].path, 99.0F - gap_m - 2.5F, speed_mps);
  }
};

// MRM-007 Astride at 10 m/s, the one behind at 14 m/s: he needs 29.8 - 6.3 = 23.5 m. The stop ends in the
// lane in which he is not, 5 m behind us; or, one in each, in that in which he is farther behind.
TEST(MinimumRisk, StopsInTheLaneWhereItIsLeastInTheWay) {
  for (const int lane : {0, 1}) {
    Astride one(10.0F);
    one.behind(lane, 5.0F, 14.0F);
    const float other_m = lane == 0 ? kLaneWidthM : 0.0F;
    EXPECT_NEAR(end_of(manoeuvre(one.scene, one.start)).rear_axle.y_m, other_m, 0.7F) << lane;
    Astride both(10.0F);
    both.behind(lane, 5.0F, 14.0F);
    both.behind(1 - lane, 15.0F, 14.0F);
    TrajectoryPoint state = both.start;
    for (int i = 0; i < 30; ++i) {
      put_ego(both.scene, state);
      state = manoeuvre(both.scene, state).points[1];
      for (Agent& agent : both.scene.agents) agent.track.centre.x_m += 1.2F;
    }
    EXPECT_NEAR(state.rear_axle.y_m, other_m, 0.7F) << lane;
  }
}

// MRM-007 One beside us in the left lane, a metre ahead: worse than one 5 m behind in the right one.
TEST(MinimumRisk, DoesNotStopWhereSomebodyIsBesideUs) {
  Astride astride(10.0F);
  astride.behind(0, 5.0F, 14.0F);
  astride.behind(1, -8.5F, 10.0F);
  EXPECT_NEAR(end_of(manoeuvre(astride.scene, astride.start)).rear_axle.y_m, 0.0F, 0.7F);
}

// MRM-007 At 3 m/s a stop with 4 m/s^2 would end after 1.1 m, astride. It ends in a lane instead.
TEST(MinimumRisk, DoesNotStopBetweenTwoLanes) {
  Astride astride(3.0F);
  TrajectoryPoint state = astride.start;
  for (int i = 0; i < 100; ++i) {
    put_ego(astride.scene, state);
    state = manoeuvre(astride.scene, state).points[1];
    EXPECT_LE(state.speed_mps, 3.0F);
  }
  EXPECT_LT(state.speed_mps, 0.3F);
  const float aside_m =
      std::fmin(std::fabs(state.rear_axle.y_m), std::fabs(state.rear_axle.y_m - kLaneWidthM));
  EXPECT_LT(aside_m, 0.75F);
}

// MRM-005 At rest astride, before a zone: the pose stays.
TEST(MinimumRisk, StaysAtRestAstride) {
  Astride astride(0.0F);
  ConflictZone zone;
  zone.entry_s_m = 110.0F;
  zone.exit_s_m = 120.0F;
  for (EgoPath& path : astride.scene.ego_paths) (void)path.zones.push(zone);
  const TrajectoryPoint end = end_of(manoeuvre(astride.scene, astride.start));
  EXPECT_EQ(end.rear_axle.x_m, astride.start.rear_axle.x_m);
  EXPECT_EQ(end.speed_mps, 0.0F);
}

// MRM-008 Coming into the left lane, 10 m in front of one at 14 m/s, one 3 m behind us in the right one: he
// takes 7 m to notice and 32.7 m to stop with 3 m/s^2. We leave him those with 100 / (2 * (39.7 + 1 - 10)) =
// 1.63 m/s^2.
TEST(MinimumRisk, BrakesGentlyInFrontOfWhoIsBehindInTheLaneEntered) {
  Astride astride(10.0F);
  astride.behind(0, 3.0F, 14.0F);
  astride.behind(1, 10.0F, 14.0F);
  EXPECT_NEAR(hardest(manoeuvre(astride.scene, astride.start)), -1.63F, 0.02F);
}

// MRM-006 Nothing known at all, wheels turned: braking on the present curvature, to rest.
TEST(MinimumRisk, NeedsNoMap) {
  TrajectoryPoint start;
  start.speed_mps = 8.0F;
  start.curvature_1pm = 0.1F;
  const Trajectory trajectory = manoeuvre(Scene{}, start);
  EXPECT_EQ(end_of(trajectory).speed_mps, 0.0F);
  EXPECT_EQ(end_of(trajectory).curvature_1pm, 0.1F);
  EXPECT_NEAR(end_of(trajectory).rear_axle.heading_rad, 0.1F * 8.0F, 0.01F);  // 64 / 8 = 8 m of way
}

}  // namespace
}  // namespace s4tp
