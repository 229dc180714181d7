#include "sim_host/baselines/goal_distance.hpp"

#include <algorithm>
#include <cmath>

#include "algo/occupancy/pace.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::baselines {
namespace {

constexpr float kReachM = 15.0F;  // of a projection onto the path, from where a motion should be

/// Where a motion along an ego path is at one of its points.
struct Place {
  scene::Frenet rear_axle;
  float speed_mps = 0.0F;
};

/// At the first point with the front at `front_s_m` or beyond, else at the motion's end. \param start_s_m  of its first point
Place place_at(const scene::Scene& scene, const scene::EgoPath& path, const Trajectory& trajectory,
               float start_s_m, float front_s_m, const Parameters& parameters) {
  const float to_front_m = trajectory::rear_axle_to_front_m(parameters);
  float s_m = start_s_m;
  int i = 0;
  while (i < kHorizonSteps && s_m + to_front_m < front_s_m) {
    s_m += 0.5F * kStepS * (trajectory.points[i].speed_mps + trajectory.points[i + 1].speed_mps);
    ++i;
  }
  const TrajectoryPoint& there = trajectory.points[i];
  return {scene::project(*scene.map, path.path, position(there.rear_axle), s_m, kReachM), there.speed_mps};
}

/// Share of the way from the line into the lane that is left to drive sideways, `d_m` from its centre.
float unmade(float d_m, float width_m) {
  return std::clamp(2.0F * std::abs(d_m) / width_m - 1.0F, 0.0F, 1.0F);
}

/// Room [m] lacking for the change we are on, to be over the line before our lane ends; <= 0: it is in time, or need not be.
float change_late_m(const scene::Scene& scene, const scene::EgoPath& path, const Trajectory& trajectory,
                    float start_s_m, const Parameters& parameters) {
  const scene::EgoPath& own = scene.ego_paths[0];
  if (std::abs(own.changes_needed) <= std::abs(path.changes_needed)) return 0.0F;
  const float own_end_s_m = own.route_end_s_m + path.frenet.s_m - own.frenet.s_m;
  const Place last = place_at(scene, path, trajectory, start_s_m, own_end_s_m, parameters);
  const float left =
      unmade(last.rear_axle.d_m, scene::path_point(*scene.map, path.path, last.rear_axle.s_m).width_m);
  if (left <= 0.0F) return 0.0F;
  const float front_s_m = last.rear_axle.s_m + trajectory::rear_axle_to_front_m(parameters);
  return scene::kChangeWayM * left - (own_end_s_m - front_s_m);
}

/// Room [m] lacking after the motion's end for the changes left then, as each may have to be waited for; <= 0: there is enough.
float changes_late_m(const scene::EgoPath& path, const Place& end, const Parameters& parameters) {
  const float front_s_m = end.rear_axle.s_m + trajectory::rear_axle_to_front_m(parameters);
  float way_m = occupancy::stopping_way_m(end.speed_mps, parameters.comfort.braking_mps2);
  float lacking_m = 0.0F;
  for (const float by_s_m : path.change_by_s_m) {
    way_m += scene::kChangeWayM;
    lacking_m = std::max(lacking_m, way_m - (by_s_m - front_s_m));
  }
  return lacking_m;
}

}  // namespace

float goal_distance(const scene::Scene& scene, const scene::EgoPath& path, const Trajectory& trajectory,
                    const Parameters& parameters) {
  const Point start = position(trajectory.points[0].rear_axle);
  const float start_s_m = scene::project(*scene.map, path.path, start, path.frenet.s_m, kReachM).s_m;
  const Place end = place_at(scene, path, trajectory, start_s_m, trajectory::kNoDeadEndM, parameters);
  const scene::PathPoint here = scene::path_point(*scene.map, path.path, start_s_m);
  const float longest_m = std::max(here.speed_limit_mps, 1.0F) * kHorizonS;
  const bool beside = path.manoeuvre != scene::Manoeuvre::kKeep;
  const float changes = static_cast<float>(std::abs(path.changes_needed)) +
                        (beside ? unmade(end.rear_axle.d_m, here.width_m) : 0.0F);
  const float lacking_m = std::max(0.0F, longest_m - (end.rear_axle.s_m - start_s_m)) +
                          parameters.comfort.lane_change_s * here.speed_limit_mps * changes;
  const float late_m = std::max(change_late_m(scene, path, trajectory, start_s_m, parameters),
                                changes_late_m(path, end, parameters));
  return lacking_m / longest_m + kMissed * std::clamp(late_m / scene::kChangeWayM, 0.0F, 1.0F);
}

}  // namespace s4tp::baselines
