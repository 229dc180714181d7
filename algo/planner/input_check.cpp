#include "algo/planner/input_check.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::planner {
namespace {

constexpr std::uint32_t kMaxLeadMs = 200;  // plan start after the snapshot
constexpr float kFarthestM = 1e5F;         // from the frame's origin

bool within(float x, float low, float high) {
  return is_finite(x) && x >= low && x <= high;
}

bool valid(const Pose& pose) {
  return abs(pose.x_m) < kFarthestM && abs(pose.y_m) < kFarthestM && within(pose.heading_rad, -kPi, kPi);
}

bool valid(const Track& track) {
  return valid(track.centre) && within(track.speed_mps, 0.0F, 61.0F) &&
         within(track.acceleration_mps2, -13.0F, 13.0F) && within(track.yaw_rate_radps, -1.3F, 1.3F) &&
         within(track.length_m, 0.5F, 26.0F) && within(track.width_m, 0.3F, 3.2F);
}

}  // namespace

bool is_valid(const EgoState& ego) {
  return valid(ego.rear_axle) && within(ego.speed_mps, 0.0F, 60.0F) &&
         within(ego.acceleration_mps2, -12.0F, 12.0F) && within(ego.yaw_rate_radps, -2.1F, 2.1F) &&
         within(ego.steering_rad, -0.8F, 0.8F);
}

bool is_valid(const Plan& plan, const Parameters& parameters) {
  if (plan.kind == PlanKind::kNone) return true;
  return plan.kind <= PlanKind::kMinimumRisk && trajectory::keeps_limits(plan.trajectory, parameters) &&
         within(plan.fail_safe.branch_s, 0.0F, 3.0F) && within(plan.fail_safe.braking_mps2, 0.0F, 13.0F);
}

bool are_others_valid(const PlannerInput& input) {
  if (input.start_ms - input.now_ms > kMaxLeadMs) return false;
  for (const Track& track : input.tracks) {
    if (!valid(track)) return false;
  }
  return true;
}

}  // namespace s4tp::planner
