#include "algo/safety/lane_change.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp {
namespace {

constexpr float kSwingS = 0.5F;  // sideways motion that goes on before steering back shows

/// Whether a lane is that of the path at one of its parts.
bool on_path(const LanePath& path, LaneIndex lane) {
  for (const PathLane& part : path.lanes) {
    if (part.lane == lane) return true;
  }
  return false;
}

}  // namespace

bool change_under_way(const Scene& scene, const EgoPath& path, const TrajectoryPoint& start,
                      const Parameters& parameters) {
  const Frenet frenet = project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 15.0F);
  const float half_lane_m = 0.5F * path_point(*scene.map, path.path, frenet.s_m).width_m;
  const SinCos turned = sin_cos(wrap_angle(start.rear_axle.heading_rad - frenet.heading_rad));
  const float towards = frenet.d_m > 0.0F ? -turned.sin : turned.sin;
  const float stop_m = square(start.speed_mps) / (2.0F * parameters.comfort.braking_mps2);
  // The corner nearest to our lane while we head out of it is behind; a lane beside is one we head for.
  const float on_m = towards > 0.0F || path.manoeuvre != Manoeuvre::kKeep
                         ? rear_axle_to_front_m(parameters) + min(stop_m, kSwingS * start.speed_mps)
                         : -parameters.vehicle.rear_overhang_m;
  const float corner_m = abs(frenet.d_m) - on_m * towards - 0.5F * parameters.vehicle.width_m * turned.cos;
  return corner_m < half_lane_m;
}

bool joins(const Scene& scene, const EgoPath& path, const Agent& agent) {
  if (agent.lane == kNoLaneIndex || on_path(path.path, agent.lane)) return false;
  const Lane& own = scene.map->lanes[agent.lane];
  for (const LanePath& way : agent.paths) {
    if (way.lanes.empty()) continue;
    const LaneIndex lane = way.lanes[0].lane;
    if ((lane == own.left || lane == own.right) && on_path(path.path, lane)) return true;
  }
  return false;
}

Neighbours find_neighbours(const Scene& scene, const EgoPath& path, const Parameters& parameters) {
  const float s_m = path.frenet.s_m;
  Neighbours found{find_leader(scene, path, s_m, parameters), find_follower(scene, path, s_m, parameters),
                   -1};
  const float centre_s_m = s_m + rear_axle_to_centre_m(parameters);
  const float front_s_m = s_m + rear_axle_to_front_m(parameters);
  const float rear_s_m = s_m - parameters.vehicle.rear_overhang_m;
  for (int i = 0; i < scene.agents.size(); ++i) {
    const Agent& agent = scene.agents[i];
    if (!joins(scene, path, agent)) continue;
    bool known = false;
    const OnPath seen = see_on_path(scene, path, agent, parameters, /*whole_road=*/true, known);
    if (!known || seen.along_mps < 0.0F) continue;
    const bool ahead = seen.centre_s_m > centre_s_m;
    const float gap_m = ahead ? seen.centre_s_m - seen.half_length_m - front_s_m
                              : rear_s_m - seen.centre_s_m - seen.half_length_m;
    if (gap_m < 0.0F) {
      found.joins_beside = i;
      continue;
    }
    Leader& nearest = ahead ? found.leader : found.follower;
    if (nearest.agent >= 0 && gap_m >= nearest.gap_m) continue;
    nearest = {i, gap_m, seen.along_mps, agent.track.acceleration_mps2};
  }
  return found;
}

}  // namespace s4tp
