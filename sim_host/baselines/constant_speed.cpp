#include "sim_host/baselines/constant_speed.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/math.hpp"
#include "algo/trajectory/candidates.hpp"
#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

const RegisterPlanner kRegistered{
    planner<ConstantSpeedPlanner>("constant_speed", "holds its speed along the route: the floor")};

/// The lane beside ours when that brings us nearer to the route's, else ours.
const scene::EgoPath& wanted_path(const scene::Scene& scene) {
  return *std::min_element(scene.ego_paths.begin(), scene.ego_paths.end(),
                           [](const scene::EgoPath& a, const scene::EgoPath& b) {
                             return std::abs(a.changes_needed) < std::abs(b.changes_needed);
                           });
}

}  // namespace

Status ConstantSpeedPlanner::init(const Parameters& parameters) {
  int first_bad = 0;
  parameters_ = parameters;
  scene_builder_.reset();
  speed_mps_ = -1.0F;
  return validate(parameters, first_bad);
}

Status ConstantSpeedPlanner::plan(const planner::PlannerInput& input, Plan& plan,
                                  planner::Explanation& explanation) {
  explanation = planner::Explanation{};
  if (speed_mps_ < 0.0F) speed_mps_ = input.ego.speed_mps;
  const Plan running = input.running != nullptr ? *input.running : Plan{};
  const TrajectoryPoint start =
      trajectory::plan_start(input.ego, input.now_ms, running, input.start_ms, parameters_);
  plan.start_ms = input.start_ms;
  plan.kind = PlanKind::kDrive;

  const Status status = scene_builder_.build(input.now_ms, input.ego, TrackList{}, input.tracks_ms, input.map,
                                             parameters_, scene_);
  const bool has_road = status == Status::kOk;
  const scene::EgoPath* path = has_road ? &wanted_path(scene_) : nullptr;
  const scene::Frenet begin =
      has_road ? scene::project(*input.map, path->path, position(start.rear_axle), path->frenet.s_m, 20.0F)
               : scene::Frenet{};
  const float slope =
      has_road
          ? s4tp::tan(std::clamp(wrap_angle(start.rear_axle.heading_rad - begin.heading_rad), -1.0F, 1.0F))
          : 0.0F;

  for (int i = 0; i < kTrajectoryPoints; ++i) {
    TrajectoryPoint& point = plan.trajectory.points[i];
    point = start;
    point.speed_mps = speed_mps_;
    point.acceleration_mps2 = 0.0F;
    if (i == 0) continue;
    const float ahead_m = speed_mps_ * kStepS * static_cast<float>(i);
    if (!has_road) {
      point.rear_axle = shift_ahead(start.rear_axle, ahead_m);
      continue;
    }
    // Sideways back to the centre line within about 3 s, as a critically damped spring would.
    const float reach_m = std::max(speed_mps_, 2.0F);
    const float decay = std::exp(-ahead_m / reach_m);
    const float left_m = (begin.d_m + (slope + begin.d_m / reach_m) * ahead_m) * decay;
    const float drift = (slope - (slope + begin.d_m / reach_m) * ahead_m / reach_m) * decay;
    const scene::PathPoint centre = scene::path_point(*input.map, path->path, begin.s_m + ahead_m);
    const Point at = offset_point(centre.pose, 0.0F, left_m);
    point.rear_axle = {at.x_m, at.y_m, wrap_angle(centre.pose.heading_rad + s4tp::atan(drift))};
    const float turned =
        wrap_angle(point.rear_axle.heading_rad - plan.trajectory.points[i - 1].rear_axle.heading_rad);
    point.curvature_1pm = turned / std::max(speed_mps_ * kStepS, 0.05F);
  }
  return Status::kOk;
}

}  // namespace s4tp::baselines
