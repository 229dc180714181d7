// Candidates and the minimum-risk manoeuvre from random states on random roads.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "algo/safety/fail_safe.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"
#include "tests/support/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::safety {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr std::uint32_t kNow = 5000;

/// `low` .. `high` in hundredths.
float uniform(int low, int high) {
  return 0.01F * static_cast<float>(*rc::gen::inRange(low, high + 1));
}

bool finite(const TrajectoryPoint& p) {
  return std::isfinite(p.rear_axle.x_m) && std::isfinite(p.rear_axle.y_m) &&
         std::isfinite(p.rear_axle.heading_rad) && std::isfinite(p.speed_mps) &&
         std::isfinite(p.acceleration_mps2) && std::isfinite(p.curvature_1pm);
}

/// A curved road, a vehicle or two on it, a zone, and we somewhere near its centre line.
struct World {
  LaneMap map = curved_road(uniform(1000, 10000), uniform(-150, 150));
  scene::Scene scene;
  TrajectoryPoint start;
  World() {
    const scene::LanePath path = path_of(map, {0, 1, 2});
    scene::EgoPath& ego_path = add_ego_path(scene, map, path);
    if (*rc::gen::arbitrary<bool>()) {
      scene::ConflictZone zone;
      zone.entry_s_m = uniform(1000, 9000);
      zone.exit_s_m = zone.entry_s_m + uniform(300, 1500);
      zone.stop_s_m = zone.entry_s_m + uniform(-500, 150);
      zone.other_lane = 2;
      (void)ego_path.zones.push(zone);
    }
    for (int i = *rc::gen::inRange(0, 3); i > 0; --i)
      add_vehicle(scene, map, path, uniform(0, 12000), uniform(0, 1500), uniform(-300, 300));
    scene.time_ms = kNow - 100;
    start = state_on(map, path, uniform(0, 10000), uniform(0, 1600), uniform(-150, 150));
    start.rear_axle.heading_rad += uniform(-30, 30);
    start.acceleration_mps2 = start.speed_mps > 0.0F ? uniform(-800, 350) : 0.0F;
    start.curvature_1pm = uniform(-20, 20);
    put_ego(scene, start);
  }
};

void check_motion(const Trajectory& trajectory) {
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    RC_ASSERT(finite(trajectory.points[i]));
    RC_ASSERT(trajectory.points[i].speed_mps >= 0.0F);
  }
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& a = trajectory.points[i - 1];
    const TrajectoryPoint& b = trajectory.points[i];
    const float moved_m = std::hypot(b.rear_axle.x_m - a.rear_axle.x_m, b.rear_axle.y_m - a.rear_axle.y_m);
    // By the mean speed; five percent and 5 cm for a curvature that changes within the step.
    RC_ASSERT(moved_m <= 0.5F * (a.speed_mps + b.speed_mps) * kStepS * 1.05F + 0.05F);
    if (a.speed_mps == 0.0F && b.speed_mps == 0.0F) RC_ASSERT(moved_m == 0.0F);
  }
}

// CAND-009, CAND-010 At most 24, each feasible, finite, never backwards, starting exactly at the start,
// continuous.
TEST(MotionProperty, CandidatesAreMotions) {
  EXPECT_TRUE(rc::check([] {
    const World world;
    const Parameters parameters;
    trajectory::ReferenceLines lines;
    test::build_lines_of(world.scene, world.start, Parameters{}, lines);
    trajectory::CandidateList list;
    int left_out = 0;
    trajectory::generate_candidates(world.scene, world.start, Plan{}, kNow, parameters, kMaxCandidates, lines,
                                    list, left_out);
    RC_ASSERT(list.size() <= kMaxCandidates);
    RC_ASSERT(left_out >= 0);
    for (const trajectory::Candidate& candidate : list) {
      Trajectory trajectory;
      trajectory::roll_out(lines[candidate.path], candidate, world.start, Plan{}, kNow, parameters,
                           trajectory);
      RC_ASSERT(trajectory.points[0].rear_axle.x_m == world.start.rear_axle.x_m);
      RC_ASSERT(trajectory.points[0].curvature_1pm == world.start.curvature_1pm);
      RC_ASSERT(trajectory::feasible(trajectory, parameters));
      check_motion(trajectory);
    }
  }));
}

// CAND-009 From an ordinary state (0.3 m beside, 0.05 rad askew, comfortable speed) there is always a way to
// brake: to rest, or no further than 5 cm beyond rest at 3 m/s^2 after 0.3 s, where one that comes that near has
// replaced it as its twin.
TEST(MotionProperty, OrdinaryStatesHaveCandidates) {
  EXPECT_TRUE(rc::check([] {
    World world;
    world.start = state_on(world.map, world.scene.ego_paths[0].path, uniform(0, 10000), uniform(0, 500),
                           uniform(-30, 30));
    world.start.rear_axle.heading_rad += uniform(-5, 5);
    world.start.curvature_1pm =
        scene::path_point(world.map, world.scene.ego_paths[0].path, world.scene.ego_paths[0].frenet.s_m)
            .curvature_1pm;
    put_ego(world.scene, world.start);
    world.start.curvature_1pm =
        scene::path_point(world.map, world.scene.ego_paths[0].path, world.scene.ego_paths[0].frenet.s_m)
            .curvature_1pm;
    trajectory::ReferenceLines lines;
    test::build_lines_of(world.scene, world.start, Parameters{}, lines);
    trajectory::CandidateList list;
    int left_out = 0;
    trajectory::generate_candidates(world.scene, world.start, Plan{}, kNow, Parameters{}, kMaxCandidates,
                                    lines, list, left_out);
    const float speed_mps = world.start.speed_mps;
    const float rest_m = 0.3F * speed_mps + speed_mps * speed_mps / (2.0F * 3.0F);
    bool brakes = false;
    for (const trajectory::Candidate& candidate : list) {
      Trajectory trajectory;
      trajectory::roll_out(lines[candidate.path], candidate, world.start, Plan{}, kNow, Parameters{},
                           trajectory);
      const float came_m = s4tp::distance(position(trajectory.points[0].rear_axle),
                                          position(trajectory.points[kHorizonSteps].rear_axle));
      brakes = brakes || trajectory.points[kHorizonSteps].speed_mps == 0.0F || came_m <= rest_m + 0.05F;
    }
    RC_ASSERT(brakes);
  }));
}

// CAND-006 A stop driven cycle by cycle rests before its place, wherever it is, if there is room to brake at
// all.
TEST(MotionProperty, StopsRestBeforeTheirPlace) {
  EXPECT_TRUE(rc::check([] {
    LaneMap map = straight_road(1, 400.0F);
    scene::Scene scene;
    scene::EgoPath& ego_path = add_ego_path(scene, map, path_of(map, {0}));
    TrajectoryPoint state = state_on(map, ego_path.path, 20.0F, uniform(0, 1500));
    const float room_m = state.speed_mps * state.speed_mps / 10.0F + uniform(50, 8000);
    scene::ConflictZone zone;
    zone.stop_s_m = 20.0F + 4.0F + room_m;
    zone.entry_s_m = zone.stop_s_m;
    zone.exit_s_m = zone.stop_s_m + 5.0F;
    (void)ego_path.zones.push(zone);
    scene.time_ms = kNow;
    for (int i = 0; i < 400; ++i) {
      put_ego(scene, state);
      trajectory::ReferenceLines lines;
      test::build_lines_of(scene, state, Parameters{}, lines);
      trajectory::CandidateList list;
      int left_out = 0;
      trajectory::generate_candidates(scene, state, Plan{}, kNow, Parameters{}, kMaxCandidates, lines, list,
                                      left_out);
      const trajectory::Candidate* stop = nullptr;
      for (const trajectory::Candidate& candidate : list)
        if (candidate.intent == trajectory::Intent::kStop) stop = &candidate;
      if (stop == nullptr) break;
      Trajectory trajectory;
      trajectory::roll_out(lines[stop->path], *stop, state, Plan{}, kNow, Parameters{}, trajectory);
      const bool rests = i > 5 && state.speed_mps == 0.0F && trajectory.points[1].speed_mps == 0.0F;
      state = trajectory.points[1];
      RC_ASSERT(state.rear_axle.x_m <= 20.0F + room_m + 0.02F);
      if (rests) break;
    }
    RC_ASSERT(state.rear_axle.x_m > 20.0F + room_m - 1.5F);
  }));
}

// FAIL-001 FAIL-002 FAIL-003 From any state, along any plan or none: finite, continuous, the path's own;
// driven cycle by cycle, each from the one before, it is at rest within branch + v / b and a second for the
// build-up.
TEST(MotionProperty, FailSafeAlwaysStops) {
  EXPECT_TRUE(rc::check([] {
    const World world;
    TrajectoryPoint state = world.start;
    Plan running;
    if (*rc::gen::inRange(0, 4) != 0) {
      running.kind = PlanKind::kDrive;
      running.start_ms = kNow;
      running.fail_safe = {0.1F * static_cast<float>(*rc::gen::inRange(0, 31)), 6.0F};
      running.trajectory.points[0] = state;
      for (int i = 1; i < kTrajectoryPoints; ++i)
        running.trajectory.points[i] =
            trajectory::bicycle_step(running.trajectory.points[i - 1], 0.0F, 0.0F, kStepS);
    }
    // What the jerk lets it gain before it loses, twice: a^2 / 2j <= 0.4 m/s at 3 m/s^2 and 12 m/s^3.
    float fastest_mps = state.speed_mps + 0.8F;
    for (const TrajectoryPoint& point : running.trajectory.points)
      fastest_mps = std::fmax(fastest_mps, point.speed_mps + 0.8F);
    const float longest_s = running.fail_safe.branch_s + fastest_mps / 6.0F + 1.0F;
    for (int i = 1; i <= static_cast<int>(10.0F * longest_s) + 1; ++i) {
      Plan next;
      safety::drive_fail_safe(running, state, kNow + static_cast<std::uint32_t>(100 * i), 6.0F, Parameters{},
                              next);
      RC_ASSERT(next.kind == PlanKind::kMinimumRisk);
      check_motion(next.trajectory);
      state = next.trajectory.points[1];
      running = next;
      RC_ASSERT(state.speed_mps <= fastest_mps);
    }
    RC_ASSERT(state.speed_mps == 0.0F);
  }));
}

}  // namespace
}  // namespace s4tp::safety
