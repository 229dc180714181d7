#include "algo/core/trajectory.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {

TrajectoryPoint interpolate(const TrajectoryPoint& a, const TrajectoryPoint& b, float share) {
  TrajectoryPoint point;
  point.rear_axle.x_m = lerp(a.rear_axle.x_m, b.rear_axle.x_m, share);
  point.rear_axle.y_m = lerp(a.rear_axle.y_m, b.rear_axle.y_m, share);
  point.rear_axle.heading_rad = lerp_angle(a.rear_axle.heading_rad, b.rear_axle.heading_rad, share);
  point.speed_mps = lerp(a.speed_mps, b.speed_mps, share);
  point.acceleration_mps2 = lerp(a.acceleration_mps2, b.acceleration_mps2, share);
  point.curvature_1pm = lerp(a.curvature_1pm, b.curvature_1pm, share);
  return point;
}

TrajectoryPoint sample(const Plan& plan, std::uint32_t time_ms) {
  // The difference of two wrapping clocks, as a signed number, is right for up to 24 days.
  const std::int32_t elapsed_ms = static_cast<std::int32_t>(time_ms - plan.start_ms);
  if (elapsed_ms <= 0) return plan.trajectory.points[0];
  if (elapsed_ms >= kHorizonSteps * kStepMs) return plan.trajectory.points[kHorizonSteps];
  const TrajectoryPoint& a = plan.trajectory.points[elapsed_ms / kStepMs];
  const TrajectoryPoint& b = plan.trajectory.points[elapsed_ms / kStepMs + 1];
  const float t = static_cast<float>(elapsed_ms % kStepMs) / static_cast<float>(kStepMs);
  return interpolate(a, b, t);
}

}  // namespace s4tp
