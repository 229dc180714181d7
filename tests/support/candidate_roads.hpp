#pragma once
/// Roads for candidates, and short words for making and rolling them out.

#include "algo/trajectory/candidates.hpp"
#include "tests/support/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {

using namespace test;  // NOLINT: the map builders are the language of these tests

inline constexpr std::uint32_t kNow = 5000;

/// The left turn of the scenario: 50 m straight, 90 degrees on radius 10.7 m in 8 vertices, 80 m straight.
struct LeftTurn {
  LaneMap map;
  scene::LanePath path;
  LeftTurn() {
    const LaneIndex before = add_lane(map, {{-50.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex turn = add_lane(map, arc({0.0F, 0.0F, 0.0F}, 10.7F, 1.57079633F, 8));
    const Point end = map.lanes[turn].points[7];
    const LaneIndex after = add_lane(map, {end, {end.x_m, end.y_m + 80.0F}});
    link(map, turn, after);
    link(map, before, turn);
    path = path_of(map, {before, turn, after});
  }
};

struct Roads {
  LaneMap map = straight_road(3, 300.0F);
  scene::Scene scene;
  /// In the middle of three lanes.
  Roads(float s_m, float speed_mps) {
    add_ego_path(scene, map, path_of(map, {1}));
    add_ego_path(scene, map, path_of(map, {2}), scene::Manoeuvre::kLeft);
    add_ego_path(scene, map, path_of(map, {0}), scene::Manoeuvre::kRight);
    scene.time_ms = kNow;
    start = state_on(map, scene.ego_paths[0].path, s_m, speed_mps);
    put_ego(scene, start);
  }
  TrajectoryPoint start;
};

inline CandidateList generate(const scene::Scene& scene, const TrajectoryPoint& start,
                              const Plan& running = {}, int* left_out = nullptr) {
  ReferenceLines lines;
  build_lines_of(scene, start, Parameters{}, lines);
  CandidateList list;
  int missing = 0;
  generate_candidates(scene, start, running, kNow, Parameters{}, kMaxCandidates, lines, list, missing);
  if (left_out != nullptr) *left_out = missing;
  return list;
}

inline Trajectory rolled(const scene::Scene& scene, const Candidate& candidate, const TrajectoryPoint& start,
                         const Plan& running = {}) {
  ReferenceLine line;
  build_reference(*scene.map, scene.ego_paths[candidate.path].path, candidate.start_s_m, start.speed_mps,
                  Parameters{}, line);
  line.lateral_offset_m = scene.ego_paths[candidate.path].lateral_offset_m;
  Trajectory trajectory;
  roll_out(line, candidate, start, running, kNow, Parameters{}, trajectory);
  return trajectory;
}

inline const Candidate* find(const CandidateList& list, int path, Intent intent,
                             float acceleration_mps2 = 0.0F) {
  for (const Candidate& candidate : list) {
    if (candidate.path != path || candidate.intent != intent) continue;
    if (intent != Intent::kAccelerate || candidate.acceleration_mps2 == acceleration_mps2) return &candidate;
  }
  return nullptr;
}

inline const TrajectoryPoint& end_of(const Trajectory& trajectory) {
  return trajectory.points[kHorizonSteps];
}

}  // namespace s4tp::trajectory
