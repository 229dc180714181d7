// Candidates and their roll-outs on hand-made roads.

#include "algo/trajectory/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/speed_profile.hpp"
#include "tests/support/candidate_roads.hpp"
#include "tests/support/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

// CAND-009 In the middle of three lanes behind a leader: each path has following and braking; never over 24.
TEST(Candidates, CoverEveryPathAndIntent) {
  Roads roads(50.0F, 10.0F);
  add_vehicle(roads.scene, roads.map, roads.scene.ego_paths[0].path, 90.0F, 8.0F);
  int left_out = -1;
  const CandidateList list = generate(roads.scene, roads.start, {}, &left_out);
  EXPECT_LE(list.size(), kMaxCandidates);
  EXPECT_GE(list.size(), 15);
  EXPECT_GE(left_out, 0);
  EXPECT_NE(find(list, 0, Intent::kFollow), nullptr);
  for (int path = 0; path < 3; ++path) {
    for (const float acceleration : {2.0F, 0.0F, -3.0F}) {
      EXPECT_NE(find(list, path, Intent::kAccelerate, acceleration), nullptr) << path << ' ' << acceleration;
    }
  }
  EXPECT_NE(find(list, 0, Intent::kAccelerate, -6.0F), nullptr);
}

// CAND-009 At the limit of 13.89 m/s accelerating by 1, 2 or 3.5 is the same motion: it is there once.
TEST(Candidates, TwinsCountOnce) {
  Roads roads(50.0F, kLimitMps);
  const CandidateList list = generate(roads.scene, roads.start);
  int faster = 0;
  for (const Candidate& candidate : list) {
    faster +=
        candidate.path == 0 && candidate.intent == Intent::kAccelerate && candidate.acceleration_mps2 >= 0.0F;
  }
  EXPECT_EQ(faster, 1);
}

// CAND-010 A lane change at 10 m/s ends 3.2 m to the left, parallel, feasible, and the way there has no jump.
TEST(Candidates, LaneChangeReachesTheOtherCentre) {
  Roads roads(50.0F, 10.0F);
  const CandidateList list = generate(roads.scene, roads.start);
  const Candidate* left = find(list, 1, Intent::kAccelerate, 0.0F);
  ASSERT_NE(left, nullptr);
  const Trajectory trajectory = rolled(roads.scene, *left, roads.start);
  EXPECT_NEAR(end_of(trajectory).rear_axle.y_m, 2.0F * kLaneWidthM, 0.05F);
  EXPECT_NEAR(end_of(trajectory).rear_axle.heading_rad, 0.0F, 0.02F);
  EXPECT_TRUE(feasible(trajectory, Parameters{}));
  float lateral = 0.0F;
  for (const TrajectoryPoint& point : trajectory.points) {
    lateral = std::max(lateral, std::fabs(point.curvature_1pm) * point.speed_mps * point.speed_mps);
  }
  EXPECT_LT(lateral, 2.6F);
}

// CAND-005 At rest braking candidates hold the pose bit for bit; driving off needs no lateral jump.
TEST(Candidates, StandstillAndRestart) {
  Roads roads(50.0F, 0.0F);
  roads.start.curvature_1pm = 0.05F;
  const CandidateList list = generate(roads.scene, roads.start);
  bool stands = false;
  bool drives = false;
  for (const Candidate& candidate : list) {
    const Trajectory trajectory = rolled(roads.scene, candidate, roads.start);
    const TrajectoryPoint& end = end_of(trajectory);
    if (end.speed_mps > 0.0F) {
      drives = true;
      continue;
    }
    stands = true;
    for (const TrajectoryPoint& point : trajectory.points) {
      EXPECT_EQ(point.rear_axle.x_m, roads.start.rear_axle.x_m);
      EXPECT_EQ(point.rear_axle.heading_rad, roads.start.rear_axle.heading_rad);
      EXPECT_EQ(point.curvature_1pm, roads.start.curvature_1pm);
    }
  }
  EXPECT_TRUE(stands);
  EXPECT_TRUE(drives);
}

// CAND-006 The road ends 60 m ahead of the rear axle and the goal is not on it: the stop rests with its front
// (4 m ahead of the axle) before the end, not more than 3 m before, and brakes comfortably: at most 2.9
// m/s^2.
TEST(Candidates, StopRestsBeforeItsLine) {
  LaneMap map = straight_road(1, 100.0F);
  map.lanes[0].on_route = false;
  scene::Scene scene;
  scene.time_ms = kNow;
  add_ego_path(scene, map, path_of(map, {0}));
  TrajectoryPoint state = state_on(map, scene.ego_paths[0].path, 40.0F, 10.0F);
  float hardest = 0.0F;
  for (int i = 0; i < 150; ++i) {
    put_ego(scene, state);
    const CandidateList list = generate(scene, state);
    const Candidate* stop = find(list, 0, Intent::kStop);
    if (stop == nullptr) break;  // a twin of standing still
    state = rolled(scene, *stop, state).points[1];
    hardest = std::min(hardest, state.acceleration_mps2);
  }
  EXPECT_EQ(state.speed_mps, 0.0F);
  EXPECT_LT(state.rear_axle.x_m + 4.0F, 100.0F);
  EXPECT_GT(state.rear_axle.x_m + 4.0F, 97.0F);
  EXPECT_GT(hardest, -2.9F);
}

// CAND-006 Every zone gives a place to stop: front at stop_s, or, that passed, box centre 1 m before the
// zone.
TEST(Candidates, StopsBeforeConflictZones) {
  LaneMap map = straight_road(1, 300.0F);
  scene::Scene scene;
  scene.time_ms = kNow;
  scene::EgoPath& ego_path = add_ego_path(scene, map, path_of(map, {0}));
  scene::ConflictZone zone;
  zone.entry_s_m = 80.0F;
  zone.exit_s_m = 90.0F;
  zone.stop_s_m = 78.0F;
  ASSERT_TRUE(ego_path.zones.push(zone));
  TrajectoryPoint start = state_on(map, ego_path.path, 50.0F, 8.0F);
  put_ego(scene, start);
  CandidateList list = generate(scene, start);
  const Candidate* stop = find(list, 0, Intent::kStop);
  ASSERT_NE(stop, nullptr);
  EXPECT_NEAR(stop->target_s_m, 78.0F - 4.0F, 1e-4F);
  start = state_on(map, ego_path.path, 75.0F, 2.0F);  // front at 79, past the line, centre at 76.5
  put_ego(scene, start);
  list = generate(scene, start);
  const Candidate* later = find(list, 0, Intent::kStop);
  ASSERT_NE(later, nullptr);
  EXPECT_NEAR(later->target_s_m, 80.0F - 1.5F - 1.0F, 1e-4F);
}

// CAND-006 Beyond the line (rear axle at 74) a stop is offered before the zone itself, centre 1 m short of
// it, but not between two zones that leave no room: the second one's edge, 90.5, lies in the first.
TEST(Candidates, CreepToTheZone) {
  LaneMap map = straight_road(1, 300.0F);
  scene::Scene scene;
  scene.time_ms = kNow;
  scene::EgoPath& ego_path = add_ego_path(scene, map, path_of(map, {0}));
  scene::ConflictZone zone;
  zone.entry_s_m = 80.0F;
  zone.exit_s_m = 90.0F;
  zone.stop_s_m = 78.0F;
  ASSERT_TRUE(ego_path.zones.push(zone));
  zone.entry_s_m = 90.5F;
  zone.exit_s_m = 95.0F;
  ASSERT_TRUE(ego_path.zones.push(zone));
  const auto furthest_stop_m = [&](float s_m) {
    const TrajectoryPoint start = state_on(map, ego_path.path, s_m, 0.0F);
    put_ego(scene, start);
    const CandidateList list = generate(scene, start);
    float furthest_m = 0.0F;
    for (const Candidate& candidate : list) {
      if (candidate.intent == Intent::kStop) furthest_m = std::max(furthest_m, candidate.target_s_m);
    }
    return furthest_m;
  };
  EXPECT_NEAR(furthest_stop_m(73.8F), 74.0F, 1e-4F);
  EXPECT_NEAR(furthest_stop_m(75.0F), 80.0F - 1.5F - 1.0F, 1e-4F);
}

/// The left turn driven from 30 m on, each cycle with the candidate that gains speed so.
struct LeftTurnDriven {
  explicit LeftTurnDriven(float acceleration_mps2) {
    LeftTurn road;
    scene::Scene scene;
    scene.time_ms = kNow;
    add_ego_path(scene, road.map, road.path);
    end = state_on(road.map, road.path, 30.0F, 8.0F);
    for (int i = 0; i < 90; ++i) {
      put_ego(scene, end);
      const CandidateList list = generate(scene, end);
      const Candidate* go = find(list, 0, Intent::kAccelerate, acceleration_mps2);
      if (go == nullptr) go = find(list, 0, Intent::kAccelerate, 2.0F);  // its twin
      feasible = feasible && go != nullptr;
      if (go == nullptr) return;
      end = rolled(scene, *go, end).points[1];
      const float s_m = scene.ego_paths[0].frenet.s_m;
      if (s_m > 52.0F && s_m < 60.0F) fastest_inside_mps = std::max(fastest_inside_mps, end.speed_mps);
      slowest_mps = std::min(slowest_mps, end.speed_mps);
      most_lateral_mps2 = std::max(most_lateral_mps2, end.curvature_1pm * end.speed_mps * end.speed_mps);
      furthest_off_m = std::max(furthest_off_m, std::fabs(scene.ego_paths[0].frenet.d_m));
    }
  }
  bool feasible = true;
  TrajectoryPoint end;
  float fastest_inside_mps = 0.0F;
  float slowest_mps = 8.0F;
  float most_lateral_mps2 = 0.0F;
  float furthest_off_m = 0.0F;
};

// CAND-010 From 8 m/s the 10.7 m turn is entered below 6 m/s and driven at sqrt(3 * 10.7) = 5.67 m/s, a
// little inside the lane's centre; each cycle has feasible candidates, and no lateral acceleration over
// 3.7 m/s^2.
TEST(Candidates, SlowDownForTheLeftTurn) {
  const LeftTurnDriven turn(2.0F);
  ASSERT_TRUE(turn.feasible);
  EXPECT_LT(turn.fastest_inside_mps, 6.0F);
  EXPECT_NEAR(turn.slowest_mps, 5.67F, 0.15F);
  EXPECT_LT(turn.most_lateral_mps2, 3.7F);
  EXPECT_LT(turn.furthest_off_m, 0.15F);
  EXPECT_GT(turn.end.speed_mps, 10.0F);
}

// CAND-027 Gaining speed with 0.85 * 3.5 = 2.975 m/s^2, which is more than comfort's 2, it is driven at
// sqrt(0.85 * 4.5 * 10.7) = 6.40 m/s, and still within the lateral acceleration of 4.5 m/s^2 that is feasible.
TEST(Candidates, WhoIsInAHurryIsSoInBends) {
  const LeftTurnDriven turn(kDriveShare * 3.5F);
  ASSERT_TRUE(turn.feasible);
  EXPECT_NEAR(turn.slowest_mps, 6.40F, 0.2F);
  EXPECT_LT(turn.most_lateral_mps2, 4.5F);
  EXPECT_LT(turn.furthest_off_m, 0.15F);
}

// CAND-027 On a straight road it keeps to the limit of 13.89 m/s, and before a slower one to that.
TEST(Candidates, WhoIsInAHurryKeepsTheLimit) {
  Roads roads(50.0F, 13.0F);
  for (const float limit_mps : {13.89F, 10.0F}) {
    Candidate hurry;
    hurry.acceleration_mps2 = 2.9F;
    const Parameters parameters;
    ReferenceLine line;
    (void)build_reference(roads.map, roads.scene.ego_paths[0].path, 50.0F, 13.0F, parameters, line);
    for (int i = 60; i < scene::kReferenceSamples; ++i)
      line.samples[i].speed_cap_mps = std::min(line.samples[i].speed_cap_mps, limit_mps);
    line.slowest_limit_mps = std::min(line.slowest_limit_mps, limit_mps);
    const float end_s_m = line.start_s_m + 70.0F * line.spacing_m;
    const float wanted_mps2 = wanted_acceleration(line, hurry, {end_s_m, limit_mps, 0.0F}, 0.0F, parameters);
    EXPECT_NEAR(wanted_mps2, 0.0F, 0.01F) << limit_mps;
  }
}

// CAND-010 Following settles at the leader's 8 m/s and 2.5 + 1.2 * 8 = 12.1 m (RSS: 8.3 m), without
// overshoot.
TEST(Candidates, FollowSettlesBehindTheLeader) {
  LaneMap map = straight_road(1, 1000.0F);
  scene::Scene scene;
  scene.time_ms = kNow;
  add_ego_path(scene, map, path_of(map, {0}));
  TrajectoryPoint state = state_on(map, scene.ego_paths[0].path, 10.0F, 13.0F);
  float leader_s_m = 70.0F;
  float least_gap = 100.0F;
  for (int i = 0; i < 600; ++i) {
    scene.agents.clear();
    add_vehicle(scene, map, scene.ego_paths[0].path, leader_s_m, 8.0F);
    put_ego(scene, state);
    const CandidateList list = generate(scene, state);
    const Candidate* follow = find(list, 0, Intent::kFollow);
    ASSERT_NE(follow, nullptr) << i;
    state = rolled(scene, *follow, state).points[1];
    leader_s_m += 0.8F;
    least_gap = std::min(least_gap, leader_s_m - 2.5F - (state.rear_axle.x_m + 4.0F));
  }
  EXPECT_NEAR(state.speed_mps, 8.0F, 0.1F);
  EXPECT_NEAR(leader_s_m - 2.5F - (state.rear_axle.x_m + 4.0F), 12.1F, 0.5F);
  EXPECT_GT(least_gap, 11.0F);
}

// CAND-015 From 13 m/s and 10 m behind: beside a gap at 8 m/s we settle in its place, without braking over
// comfort; with our own leader at 6 m/s we stay 2.5 + 1.2 * 6 = 9.7 m behind it instead, though the gap goes
// on.
TEST(Candidates, SettlesBesideAGap) {
  for (const bool leader : {false, true}) {
    LaneMap map = straight_road(2, 1000.0F);
    scene::Scene scene;
    scene.time_ms = kNow;
    add_ego_path(scene, map, path_of(map, {0}));
    add_ego_path(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft);
    TrajectoryPoint state = state_on(map, scene.ego_paths[0].path, 20.0F, 13.0F);
    MergeTarget aim{1, 30.0F, 8.0F};
    float leader_s_m = 70.0F;
    float hardest_mps2 = 0.0F;
    for (int i = 0; i < 200; ++i) {
      scene.agents.clear();
      if (leader) add_vehicle(scene, map, scene.ego_paths[0].path, leader_s_m, 6.0F);
      put_ego(scene, state);
      ReferenceLines lines;
      build_lines_of(scene, state, Parameters{}, lines);
      CandidateList list;
      int left_out = 0;
      generate_candidates(scene, state, Plan{}, kNow, Parameters{}, kMaxCandidates, lines, list, left_out,
                          aim);
      const Candidate* beside = nullptr;
      bool changes = false;
      for (const Candidate& candidate : list) {
        if (candidate.in_gap && candidate.path == 0) beside = &candidate;
        changes = changes || (candidate.in_gap && candidate.path == 1);
      }
      if (beside == nullptr) beside = find(list, 0, Intent::kFollow);  // it moves alike by then
      ASSERT_NE(beside, nullptr) << i;
      EXPECT_TRUE(changes) << i;
      state = rolled(scene, *beside, state).points[1];
      hardest_mps2 = std::min(hardest_mps2, state.acceleration_mps2);
      aim.s_m += kStepS * aim.speed_mps;
      leader_s_m += kStepS * 6.0F;
    }
    if (leader) {
      EXPECT_NEAR(leader_s_m - 2.5F - (state.rear_axle.x_m + 4.0F), 9.7F, 0.5F);
    } else {
      EXPECT_NEAR(state.rear_axle.x_m, aim.s_m, 0.5F);
      EXPECT_NEAR(state.speed_mps, 8.0F, 0.1F);
      EXPECT_GE(hardest_mps2, -2.6F);
    }
  }
}

/// Counts nothing itself.
class Onlooker final : public CandidateVisitor {
 public:
  using CandidateVisitor::CandidateVisitor;
  void visit(int) override {}
};

// CAND-021: with fewer roll-outs left than the candidates take, those that come last are left out, and told; no more
// than kMaxRollOuts are made.
TEST(Candidates, RollOutsAreCounted) {
  const Roads roads(50.0F, 12.0F);
  int sizes[2] = {};
  int missing[2] = {};
  for (int i = 0; i < 2; ++i) {
    Trajectory trajectory;
    Onlooker onlooker(trajectory);
    onlooker.roll_outs = i == 0 ? 0 : kMaxRollOuts - 12;
    ReferenceLines lines;
    build_lines_of(roads.scene, roads.start, Parameters{}, lines);
    CandidateList list;
    generate_candidates(roads.scene, roads.start, Plan{}, kNow, Parameters{}, kMaxCandidates, lines, list,
                        missing[i], onlooker);
    sizes[i] = list.size();
    EXPECT_LE(onlooker.roll_outs, kMaxRollOuts);
  }
  EXPECT_GE(sizes[1], 3);
  EXPECT_LT(sizes[1], sizes[0]);
  EXPECT_GT(missing[1], missing[0]);
}

}  // namespace
}  // namespace s4tp::trajectory
