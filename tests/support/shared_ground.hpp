#pragma once
/// A straight path of ours and one lane that crosses it or merges into it: what tests of legal occupancy and
/// of the guard are written on.

#include "algo/safety/guard.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::test {

/// We drive along +x towards ground that a lane from the south shares with us; 8 m of it on both.
///   our path: s = x + 100; zone from s = 96 to 104, of our box centre (1.5 m before the rear axle)
///   their path: s = y + 100; zone from s = 96 to 104; or beside ours, from s = 104 on the same
/// On 400 m of each there is no end of the road.
struct SharedGround {
  LaneMap map;
  scene::LanePath ours;
  scene::LanePath theirs;
  scene::Scene scene;
  Parameters parameters;
  safety::Guard guard;

  explicit SharedGround(Priority priority, bool merging = false) {
    const LaneIndex a = add_lane(map, {{-100.0F, 0.0F}, {300.0F, 0.0F}});
    // 3.6 m to the right of us until 8 m before it is in our lane, or across.
    const LaneIndex b =
        merging ? add_lane(map, {{-99.144F, -3.6F}, {-3.144F, -3.6F}, {4.0F, 0.0F}, {300.0F, 0.0F}})
                : add_lane(map, {{0.0F, -100.0F}, {0.0F, 300.0F}});
    map.lanes[b].in_junction = true;
    ours = path_of(map, {a});
    theirs = path_of(map, {b});
    scene::EgoPath& ego_path = add_ego_path(scene, map, ours);
    scene::ConflictZone zone;
    zone.entry_s_m = zone.other_entry_m = 96.0F;
    zone.exit_s_m = zone.other_exit_m = 104.0F;
    zone.stop_s_m = 95.0F;
    zone.other_lane = b;
    zone.priority = priority;
    zone.merging = merging;
    (void)ego_path.zones.push(zone);
  }

  [[nodiscard]] scene::ConflictZone& zone() { return scene.ego_paths[0].zones[0]; }
  /// Known for long.
  scene::Agent& other(float s_m, float speed_mps) {
    scene::Agent& agent = add_vehicle(scene, map, theirs, s_m, speed_mps);
    agent.known_ms = 60'000;
    return agent;
  }
  scene::Agent& leader(float s_m, float speed_mps) { return add_vehicle(scene, map, ours, s_m, speed_mps); }

  /// What the guard says of constant acceleration from box centre `centre_s_m`, with our box turned to the lane at first, and the
  /// vehicle `ahead_m` of its plan.
  safety::Verdict judge(float centre_s_m, float speed_mps, float acceleration_mps2, float turned_rad = 0.0F,
                        float ahead_m = 0.0F) {
    TrajectoryPoint start =
        state_on(map, ours, centre_s_m - trajectory::rear_axle_to_centre_m(parameters), speed_mps);
    start.acceleration_mps2 = acceleration_mps2;
    start.rear_axle.heading_rad += turned_rad;
    TrajectoryPoint driven = start;
    driven.rear_axle = shift_ahead(start.rear_axle, ahead_m);
    put_ego(scene, driven);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i)
      trajectory.points[i] =
          trajectory::bicycle_step(trajectory.points[i - 1], acceleration_mps2, 0.0F, kStepS);
    for (TrajectoryPoint& point : trajectory.points) point.acceleration_mps2 = acceleration_mps2;
    guard.look(scene, start, 0.0F, parameters);
    return guard.judge(0, trajectory);
  }
  bool safe(float centre_s_m, float speed_mps, float acceleration_mps2) {
    return judge(centre_s_m, speed_mps, acceleration_mps2).safe();
  }
  safety::Cause cause(float centre_s_m, float speed_mps, float acceleration_mps2) {
    return judge(centre_s_m, speed_mps, acceleration_mps2).cause;
  }
};

}  // namespace s4tp::test
