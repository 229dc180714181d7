#pragma once
/// Scenes for tests of motion and safety, made by hand on the maps of lane_maps.hpp: they do not depend on
/// the scene builder.

#include <vector>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp::test {

inline scene::LanePath path_of(const LaneMap& map, const std::vector<LaneIndex>& lanes) {
  scene::LanePath path;
  for (const LaneIndex lane : lanes) {
    (void)path.lanes.push({lane, path.length_m});
    path.length_m += map.lanes[lane].length_m;
  }
  return path;
}

/// Rear axle at arc length `s_m` of the path, `d_m` to the left of its centre.
inline TrajectoryPoint state_on(const LaneMap& map, const scene::LanePath& path, float s_m, float speed_mps,
                                float d_m = 0.0F) {
  const scene::PathPoint centre = scene::path_point(map, path, s_m);
  TrajectoryPoint state;
  state.rear_axle.x_m = centre.pose.x_m - d_m * std::sin(centre.pose.heading_rad);
  state.rear_axle.y_m = centre.pose.y_m + d_m * std::cos(centre.pose.heading_rad);
  state.rear_axle.heading_rad = centre.pose.heading_rad;
  state.speed_mps = speed_mps;
  return state;
}

inline void put_ego(scene::Scene& scene, const TrajectoryPoint& state) {
  scene.ego.rear_axle = state.rear_axle;
  scene.ego.speed_mps = state.speed_mps;
  scene.ego.acceleration_mps2 = state.acceleration_mps2;
  for (scene::EgoPath& path : scene.ego_paths) {
    path.frenet = scene::project(*scene.map, path.path, position(state.rear_axle), 0.0F, -1.0F);
  }
}

/// A path we may take; the goal is far beyond its end unless said otherwise. \return it, for the zones
inline scene::EgoPath& add_ego_path(scene::Scene& scene, const LaneMap& map, const scene::LanePath& path,
                                    scene::Manoeuvre manoeuvre = scene::Manoeuvre::kKeep) {
  scene.map = &map;
  scene::EgoPath ego_path;
  ego_path.manoeuvre = manoeuvre;
  ego_path.path = path;
  ego_path.route_end_s_m = path.length_m;
  ego_path.goal_s_m = path.length_m;
  (void)scene.ego_paths.push(ego_path);
  return scene.ego_paths[scene.ego_paths.size() - 1];
}

/// `changes` are to be made on the path, > 0 to the left, all of them by `by_s_m`.
inline void need_changes(scene::EgoPath& path, int changes, float by_s_m) {
  path.changes_needed = static_cast<std::int8_t>(changes);
  path.route_end_s_m = by_s_m;
  path.change_by_s_m.clear();
  for (int i = 0; i < (changes < 0 ? -changes : changes); ++i) (void)path.change_by_s_m.push(by_s_m);
}

/// Another vehicle (5.0 x 1.8 m) with its box centre at `s_m` of `path`.
inline scene::Agent& add_vehicle(scene::Scene& scene, const LaneMap& map, const scene::LanePath& path,
                                 float s_m, float speed_mps, float d_m = 0.0F) {
  scene::Agent agent;
  agent.track.id = static_cast<std::uint8_t>(scene.agents.size() + 1);
  agent.track.centre = state_on(map, path, s_m, 0.0F, d_m).rear_axle;
  agent.track.speed_mps = speed_mps;
  agent.track.length_m = 5.0F;
  agent.track.width_m = 1.8F;
  agent.lane = scene::path_point(map, path, s_m).lane;
  (void)agent.paths.push(path);
  agent.path_probability[0] = 1.0F;
  agent.frenet[0] = {s_m, d_m, agent.track.centre.heading_rad};
  (void)scene.agents.push(agent);
  return scene.agents[scene.agents.size() - 1];
}

/// The vehicle's motion along its path at constant speed, as a single future.
inline satp::Mode steady_future(const LaneMap& map, const scene::Agent& agent) {
  satp::Mode mode;
  mode.probability = 1.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const float s_m = agent.frenet[0].s_m + agent.track.speed_mps * kStepS * static_cast<float>(i + 1);
    mode.steps[i] = state_on(map, agent.paths[0], s_m, 0.0F, agent.frenet[0].d_m).rear_axle;
  }
  return mode;
}

}  // namespace s4tp::test
