#include "algo/trajectory/bicycle.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::trajectory {
namespace {

// Rounding, and a running plan sampled between its points, may touch a limit: one percent and one per mille
// of it.
constexpr float kTolerance = 1.01F;
constexpr float kLateralToleranceMps2 = 0.01F;
constexpr float kRateToleranceRadps = 0.02F;
constexpr float kSurely = 0.999F;       // more than rounding of what is compared
constexpr float kWayTolerance = 0.05F;  // of the way, for a curvature that changes within the step, and:
constexpr float kWayToleranceM = 0.05F;

}  // namespace

TrajectoryPoint bicycle_step(const TrajectoryPoint& state, float acceleration_mps2, float curvature_rate_1pms,
                             float duration_s) {
  TrajectoryPoint next = state;
  const float speed_mps = state.speed_mps + acceleration_mps2 * duration_s;
  float travelled_m = 0.5F * (state.speed_mps + speed_mps) * duration_s;
  if (speed_mps <= 0.0F) {
    // Rest is reached inside the step (or held): v^2 / 2b from where it began.
    travelled_m = acceleration_mps2 < 0.0F ? square(state.speed_mps) / (-2.0F * acceleration_mps2) : 0.0F;
  }
  next.speed_mps = max(0.0F, speed_mps);
  next.acceleration_mps2 = speed_mps > 0.0F ? acceleration_mps2 : 0.0F;
  next.curvature_1pm = state.curvature_1pm + curvature_rate_1pms * duration_s;

  const float turn_rad = 0.5F * (state.curvature_1pm + next.curvature_1pm) * travelled_m;
  const float middle_rad = state.rear_axle.heading_rad + 0.5F * turn_rad;
  next.rear_axle.x_m = state.rear_axle.x_m + travelled_m * cos(middle_rad);
  next.rear_axle.y_m = state.rear_axle.y_m + travelled_m * sin(middle_rad);
  next.rear_axle.heading_rad = wrap_angle(state.rear_axle.heading_rad + turn_rad);
  return next;
}

float steering_for(float curvature_1pm, float wheelbase_m) {
  return atan(wheelbase_m * curvature_1pm);
}

float curvature_for(float steering_rad, float wheelbase_m) {
  constexpr float kMostRad = 1.5F;  // short of a right angle
  return tan(clamp(steering_rad, -kMostRad, kMostRad)) / wheelbase_m;
}

float rear_axle_to_centre_m(const Parameters& parameters) {
  return 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
}

float rear_axle_to_front_m(const Parameters& parameters) {
  return parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
}

Box ego_box(const Pose& rear_axle, const Parameters& parameters) {
  return {shift_ahead(rear_axle, rear_axle_to_centre_m(parameters)), parameters.vehicle.length_m,
          parameters.vehicle.width_m};
}

bool as_far_as_driven(const Trajectory& trajectory) {
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& a = trajectory.points[i - 1];
    const TrajectoryPoint& b = trajectory.points[i];
    const float driven_m = 0.5F * (a.speed_mps + b.speed_mps) * kStepS;
    const float off_m = kWayTolerance * driven_m + kWayToleranceM;
    const Point moved = position(b.rear_axle) - position(a.rear_axle);
    const float moved_m2 = dot(moved, moved);
    if (moved_m2 > square(driven_m + off_m) || moved_m2 < square(max(0.0F, driven_m - off_m))) return false;
  }
  return true;
}

bool feasible(const Trajectory& trajectory, const Parameters& parameters) {
  const auto& vehicle = parameters.vehicle;
  const TrajectoryPoint& start = trajectory.points[0];
  const float start_steering_rad = abs(steering_for(start.curvature_1pm, vehicle.wheelbase_m));
  const float start_lateral_mps2 = square(start.speed_mps) * abs(start.curvature_1pm);

  // What the start itself violates cannot be undone by any motion: it only must not get worse.
  const float steering_limit_rad = kTolerance * max(vehicle.steering_max_rad, start_steering_rad);
  const float lateral_limit_mps2 =
      max(parameters.comfort.lateral_max_mps2, start_lateral_mps2) + kLateralToleranceMps2;
  const float drive_limit_mps2 = kTolerance * max(vehicle.acceleration_max_mps2, start.acceleration_mps2);
  const float brake_limit_mps2 = kTolerance * max(vehicle.braking_max_mps2, -start.acceleration_mps2);
  const float rate_limit_radps = vehicle.steering_rate_max_radps + kRateToleranceRadps;

  // atan(x) <= x and d atan(x) <= dx: who stays this far within the limits needs no arc tangent.
  const float surely_1pm = kSurely * steering_limit_rad / vehicle.wheelbase_m;
  const float surely_slew_1pm = kSurely * rate_limit_radps * kStepS / vehicle.wheelbase_m;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& point = trajectory.points[i];
    const float before_1pm = trajectory.points[i - 1].curvature_1pm;
    if (abs(point.curvature_1pm) > surely_1pm || abs(point.curvature_1pm - before_1pm) > surely_slew_1pm) {
      const float steering_rad = steering_for(point.curvature_1pm, vehicle.wheelbase_m);
      const float rate_radps = (steering_rad - steering_for(before_1pm, vehicle.wheelbase_m)) / kStepS;
      if (abs(steering_rad) > steering_limit_rad || abs(rate_radps) > rate_limit_radps) return false;
    }
    const float lateral_mps2 = square(point.speed_mps) * abs(point.curvature_1pm);
    if (lateral_mps2 > lateral_limit_mps2 || point.speed_mps < 0.0F) return false;
    if (point.acceleration_mps2 > drive_limit_mps2 || point.acceleration_mps2 < -brake_limit_mps2)
      return false;
  }
  return as_far_as_driven(trajectory);
}

}  // namespace s4tp::trajectory
