#include "algo/planner/input_check.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/input_ranges.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::planner {
namespace {

constexpr std::uint32_t kMaxLeadMs = 200;  // plan start after the snapshot

bool within(float x, float low, float high) {
  return is_finite(x) && x >= low && x <= high;
}

bool valid(const Pose& pose) {
  return abs(pose.x_m) < kFarthestInputM && abs(pose.y_m) < kFarthestInputM &&
         within(pose.heading_rad, -kPi, kPi);
}

bool valid(const Track& track) {
  return valid(track.centre) && is_taken(track.speed_mps, kTrackSpeedMps) &&
         is_taken(track.acceleration_mps2, kTrackAccelerationMps2) &&
         is_taken(track.yaw_rate_radps, kTrackYawRateRadps) && is_taken(track.length_m, kTrackLengthM) &&
         is_taken(track.width_m, kTrackWidthM);
}

}  // namespace

bool is_valid(const EgoState& ego) {
  return valid(ego.rear_axle) && is_taken(ego.speed_mps, kEgoSpeedMps) &&
         is_taken(ego.acceleration_mps2, kEgoAccelerationMps2) &&
         is_taken(ego.yaw_rate_radps, kEgoYawRateRadps) && is_taken(ego.steering_rad, kEgoSteeringRad);
}

bool is_valid(const Plan& plan, const Parameters& parameters) {
  if (plan.kind == PlanKind::kNone) return true;
  return plan.kind <= PlanKind::kMinimumRisk && trajectory::keeps_limits(plan.trajectory, parameters) &&
         within(plan.fail_safe.branch_s, 0.0F, kHorizonS) &&
         within(plan.fail_safe.braking_mps2, 0.0F, trajectory::kHardestMps2) && is_known(plan.manoeuvre);
}

bool are_others_valid(const PlannerInput& input) {
  if (input.start_ms - input.now_ms > kMaxLeadMs) return false;
  for (const Track& track : input.tracks) {
    if (!valid(track)) return false;
  }
  return true;
}

}  // namespace s4tp::planner
