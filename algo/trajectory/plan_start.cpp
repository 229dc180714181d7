#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/candidates.hpp"

namespace s4tp::trajectory {
namespace {

// How far we may be from the running plan and still go on from it (commands are continuous).
constexpr float kAlongM = 1.0F;
constexpr float kSidewaysM = 0.5F;
constexpr float kSpeedMps = 1.0F;
constexpr float kHeadingRad = 0.15F;
constexpr float kLateralMps2 = 3.0F;  // between what our wheels and the plan's curvature ask for
constexpr int kMaxSteps = 4;          // of kStepS: the start lies at most 200 ms ahead, more is cut

}  // namespace

bool plan_covers(const Plan& plan, std::uint32_t time_ms) {
  const std::int32_t elapsed_ms = static_cast<std::int32_t>(time_ms - plan.start_ms);
  return plan.kind != PlanKind::kNone && elapsed_ms >= 0 && elapsed_ms < kHorizonSteps * kStepMs;
}

TrajectoryPoint plan_start(const EgoState& ego, std::uint32_t now_ms, const Plan& running,
                           std::uint32_t start_ms, const Parameters& parameters) {
  const float curvature_1pm = curvature_for(ego.steering_rad, parameters.vehicle.wheelbase_m);
  if (plan_covers(running, now_ms) && plan_covers(running, start_ms)) {
    const TrajectoryPoint planned = sample(running, now_ms);
    const Point error = to_local(planned.rear_axle, position(ego.rear_axle));
    const float heading_error_rad = wrap_angle(ego.rear_axle.heading_rad - planned.rear_axle.heading_rad);
    if (abs(error.x_m) <= kAlongM && abs(error.y_m) <= kSidewaysM && abs(heading_error_rad) <= kHeadingRad &&
        abs(ego.speed_mps - planned.speed_mps) <= kSpeedMps &&
        square(ego.speed_mps) * abs(curvature_1pm - planned.curvature_1pm) <= kLateralMps2) {
      return sample(running, start_ms);
    }
  }

  TrajectoryPoint state;
  state.rear_axle = ego.rear_axle;
  state.speed_mps = max(0.0F, ego.speed_mps);
  state.acceleration_mps2 = clamp(ego.acceleration_mps2, -parameters.vehicle.braking_max_mps2,
                                  parameters.vehicle.acceleration_max_mps2);
  if (state.speed_mps <= 0.0F) state.acceleration_mps2 = 0.0F;
  state.curvature_1pm = curvature_1pm;

  std::int32_t left_ms = static_cast<std::int32_t>(start_ms - now_ms);
  for (int i = 0; i < kMaxSteps && left_ms > 0; ++i) {
    const std::int32_t step_ms = left_ms < kStepMs ? left_ms : kStepMs;
    state = bicycle_step(state, state.acceleration_mps2, 0.0F, 0.001F * static_cast<float>(step_ms));
    left_ms -= step_ms;
  }
  return state;
}

}  // namespace s4tp::trajectory
