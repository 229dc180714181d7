#include "algo/safety/lane_change.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp {
namespace {

constexpr float kSwingS = 0.5F;     // sideways motion that goes on before steering back shows
constexpr float kTouchM = 0.5F;     // left between us and him
constexpr float kBoundForM = 1.5F;  // nearer to a path's centre, a plan's end is in its lane

/// Whether a lane is that of the path at one of its parts.
bool on_path(const LanePath& path, LaneIndex lane) {
  for (const PathLane& part : path.lanes) {
    if (part.lane == lane) return true;
  }
  return false;
}

}  // namespace

bool changes_lane(const Scene& scene, const EgoPath& path) {
  const float width_m = path_point(*scene.map, path.path, path.frenet.s_m).width_m;
  return path.manoeuvre != Manoeuvre::kKeep && abs(path.frenet.d_m) >= 0.5F * width_m;
}

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

void mark_bound_for(const Plan& running, std::uint32_t start_ms, Scene& scene) {
  const bool drives = running.kind == PlanKind::kDrive && plan_covers(running, start_ms);
  const TrajectoryPoint& end = running.trajectory.points[kHorizonSteps];
  for (EgoPath& path : scene.ego_paths) {
    path.bound_for = false;
    if (!drives) continue;
    const float guess_s_m =
        path.frenet.s_m + distance(position(end.rear_axle), position(scene.ego.rear_axle));
    const Frenet frenet = project(*scene.map, path.path, position(end.rear_axle), guess_s_m, 15.0F);
    path.bound_for = abs(frenet.d_m) < kBoundForM;
  }
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

bool can_stay_behind(float gap_m, float speed_mps, const Trajectory& trajectory) {
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const float own_mps = trajectory.points[i].speed_mps;
    const bool brakes = static_cast<float>(i) * kStepS > kFollowerReactionS && speed_mps > own_mps;
    const float later_mps = brakes ? max(own_mps, speed_mps - kFollowerBrakingMps2 * kStepS) : speed_mps;
    gap_m = gap_m + 0.5F * kStepS * (trajectory.points[i - 1].speed_mps + own_mps - speed_mps - later_mps);
    if (gap_m < kTouchM) return false;
    speed_mps = later_mps;
  }
  const float faster_mps = max(0.0F, speed_mps - trajectory.points[kHorizonSteps].speed_mps);
  return square(faster_mps) <= 2.0F * kFollowerBrakingMps2 * (gap_m - kTouchM);
}

}  // namespace s4tp
