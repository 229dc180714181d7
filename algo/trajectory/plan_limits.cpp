#include "algo/trajectory/plan_limits.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kFarthestM =
    1.1e5F;  // an ego may be 100 km from the origin, and its plan leads on from there
constexpr float kFastestMps = 100.0F;
constexpr float kTightest1pm = 2.0F;
constexpr float kEgoSteeringRad = 0.8F;  // the largest an ego state may have
constexpr float kTolerance = 1.02F;      // twice what a candidate is allowed to be over
constexpr float kToleranceMps = 0.08F;   // the last crawl of a stop, less than 0.075 m/s, ends within a step
constexpr float kTurnRad = 0.3F;  // within a step, beyond what the curvature says: a quintic's ends, rounding
constexpr float kSlowM = 0.2F;    // a step shorter than this has hardly a direction

bool within(float x, float low, float high) {
  return x >= low && x <= high;  // not a number: false
}

}  // namespace

bool in_range(const TrajectoryPoint& point) {
  return abs(point.rear_axle.x_m) <= kFarthestM && abs(point.rear_axle.y_m) <= kFarthestM &&
         abs(point.rear_axle.heading_rad) <= kPi && within(point.speed_mps, 0.0F, kFastestMps) &&
         abs(point.acceleration_mps2) <= kHardestMps2 && abs(point.curvature_1pm) <= kTightest1pm;
}

bool keeps_limits(const Trajectory& trajectory, const Parameters& parameters) {
  const auto& vehicle = parameters.vehicle;
  const float drive_mps2 = kTolerance * vehicle.acceleration_max_mps2;
  const float brake_mps2 = kTolerance * vehicle.braking_max_mps2;
  const float most_1pm = kTolerance * curvature_for(kEgoSteeringRad, vehicle.wheelbase_m);
  for (const TrajectoryPoint& point : trajectory.points) {
    if (!in_range(point)) return false;
    if (!within(point.acceleration_mps2, -brake_mps2, drive_mps2)) return false;
    if (abs(point.curvature_1pm) > most_1pm) return false;
  }
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& a = trajectory.points[i - 1];
    const TrajectoryPoint& b = trajectory.points[i];
    const float gained_mps = b.speed_mps - a.speed_mps;
    if (!within(gained_mps, -brake_mps2 * kStepS - kToleranceMps, drive_mps2 * kStepS + kToleranceMps))
      return false;
    const Point moved = position(b.rear_axle) - position(a.rear_axle);
    const float way_m = norm(moved);
    const float turned_rad = wrap_angle(b.rear_axle.heading_rad - a.rear_axle.heading_rad);
    const float bends_rad = max(abs(a.curvature_1pm), abs(b.curvature_1pm)) * way_m + kTurnRad;
    if (abs(turned_rad) > bends_rad) return false;
    if (way_m < kSlowM || bends_rad > 1.0F) continue;
    // The chord lies along the heading half way.
    const float middle_rad = a.rear_axle.heading_rad + 0.5F * turned_rad;
    if (dot(moved, direction(middle_rad)) < cos(bends_rad) * way_m) return false;
  }
  return as_far_as_driven(trajectory);
}

}  // namespace s4tp::trajectory
