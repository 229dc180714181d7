#include "algo/trajectory/steering.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kShare = 0.95F;           // of steering angle, rate and lateral acceleration
constexpr float kShortestReturnM = 3.0F;  // way over which an offset falls to 1/e
constexpr float kReturnS = 1.2F;          // the same at speed
constexpr float kSteepestRad = 1.2F;      // off the line
constexpr float kPreviewS = 0.25F;        // wheels are turned for where we are then

/// d'' = -d / l^2 - 2 d' / l along the way: back to the line without swinging past it.
float wanted_curvature_1pm(const ReferenceLine& line, float s_m, const TrajectoryPoint& point) {
  const ReferenceLine::Sample centre = reference_at(line, s_m);
  const float ahead_1pm = curvature_at(line, s_m + kPreviewS * point.speed_mps);
  const float d_m = to_local(centre.pose, position(point.rear_axle)).y_m - line.lateral_offset_m;
  const float error_rad =
      clamp(wrap_angle(point.rear_axle.heading_rad - centre.pose.heading_rad), -kSteepestRad, kSteepestRad);
  const SinCos error = sin_cos(error_rad);
  const float cosine = error.cos;
  const float slope = error.sin / cosine;
  const float length_m = max(kShortestReturnM, kReturnS * point.speed_mps);
  const float towards_1pm = -(d_m / square(length_m) + 2.0F * slope / length_m);
  return ahead_1pm * cosine + towards_1pm * cosine * square(cosine);
}

}  // namespace

SteeringLimits steering_limits(const Parameters& parameters) {
  const auto& vehicle = parameters.vehicle;
  return {kShare * parameters.comfort.lateral_max_mps2,
          curvature_for(kShare * vehicle.steering_max_rad, vehicle.wheelbase_m),
          kShare * vehicle.steering_rate_max_radps * kStepS / vehicle.wheelbase_m};  // d atan(x) <= dx
}

void steer_step(const ReferenceLine& line, float way_m, const SteeringLimits& limits, float& s_m,
                TrajectoryPoint& point) {
  const float lateral_1pm = limits.lateral_mps2 / max(square(point.speed_mps), 1.0F);
  const float most_1pm = min(lateral_1pm, limits.curvature_1pm);
  const float slew_1pm = limits.slew_1pm;
  const float wanted_1pm = clamp(wanted_curvature_1pm(line, s_m, point), -most_1pm, most_1pm);
  const float before_1pm = point.curvature_1pm;
  point.curvature_1pm = before_1pm + clamp(wanted_1pm - before_1pm, -slew_1pm, slew_1pm);

  const float turn_rad = 0.5F * (before_1pm + point.curvature_1pm) * way_m;
  const Point along = direction(point.rear_axle.heading_rad + 0.5F * turn_rad);
  point.rear_axle.x_m = point.rear_axle.x_m + way_m * along.x_m;
  point.rear_axle.y_m = point.rear_axle.y_m + way_m * along.y_m;
  point.rear_axle.heading_rad = wrap_angle(point.rear_axle.heading_rad + turn_rad);
  s_m = locate_on(line, position(point.rear_axle), s_m + way_m).s_m;
}

}  // namespace s4tp::trajectory
