#pragma once
/// A straight path of ours and one lane that crosses it: what tests of right of way are written on.

#include "algo/safety/guard.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::test {

/// We drive along +x towards a lane that crosses at x = 0 from south to north; the zone is 8 m long on both.
///   our path: s = x + 100; zone from s = 96 to 104, stop line (front bumper) at s = 95
///   their path: s = y + 100; zone from s = 96 to 104
struct Crossing {
  LaneMap map;
  scene::LanePath ours;
  scene::LanePath theirs;
  scene::Scene scene;
  Parameters parameters;

  explicit Crossing(Priority priority) {
    const LaneIndex a = add_lane(map, {{-100.0F, 0.0F}, {300.0F, 0.0F}});
    const LaneIndex b = add_lane(map, {{0.0F, -100.0F}, {0.0F, 300.0F}});
    ours = path_of(map, {a});
    theirs = path_of(map, {b});
    scene::EgoPath& ego_path = add_ego_path(scene, map, ours);
    scene::ConflictZone zone;
    zone.entry_s_m = zone.other_entry_m = 96.0F;
    zone.exit_s_m = zone.other_exit_m = 104.0F;
    zone.stop_s_m = 95.0F;
    zone.other_lane = b;
    zone.priority = priority;
    (void)ego_path.zones.push(zone);
  }

  /// Constant acceleration from rear axle position `s_m`.
  [[nodiscard]] bool safe(float s_m, float speed_mps, float acceleration_mps2) {
    TrajectoryPoint start = state_on(map, ours, s_m, speed_mps);
    put_ego(scene, start);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i)
      trajectory.points[i] =
          trajectory::bicycle_step(trajectory.points[i - 1], acceleration_mps2, 0.0F, kStepS);
    safety::Guard guard;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(0, trajectory).safe();
  }
  scene::Agent& other(float s_m, float speed_mps) { return add_vehicle(scene, map, theirs, s_m, speed_mps); }
  [[nodiscard]] const scene::ConflictZone& zone() const { return scene.ego_paths[0].zones[0]; }
};

}  // namespace s4tp::test
