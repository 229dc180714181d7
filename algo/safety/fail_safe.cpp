#include "algo/safety/fail_safe.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/path_walk.hpp"
#include "algo/trajectory/plan_limits.hpp"
#include "algo/trajectory/speed_profile.hpp"

namespace s4tp::safety {
namespace {

constexpr float kRoundingS = 1e-3F;
constexpr float kSpeedGain1ps = 1.0F;  // while the plan is driven on: who starts beside its speed comes to it

/// Way of the plan that lies behind the point at `time_ms`.
float way_driven_m(const Plan& plan, std::uint32_t time_ms) {
  const int steps = static_cast<int>(static_cast<std::int32_t>(time_ms - plan.start_ms)) / kStepMs;
  const TrajectoryPoint* points = plan.trajectory.points;
  float way_m = 0.0F;
  for (int i = 1; i <= steps && i < kTrajectoryPoints; ++i) {
    way_m = way_m + distance(position(points[i - 1].rear_axle), position(points[i].rear_axle));
  }
  const int last = steps < kHorizonSteps ? steps : kHorizonSteps;
  return way_m + distance(position(points[last].rear_axle), position(sample(plan, time_ms).rear_axle));
}

void along_plan(const Plan& running, const TrajectoryPoint& start, std::uint32_t start_ms, float branch_s,
                float braking_mps2, const Parameters& parameters, Trajectory& trajectory) {
  const Point beside = position(start.rear_axle) - position(sample(running, start_ms).rear_axle);
  trajectory::PathWalk walk(running.trajectory);
  float way_m = way_driven_m(running, start_ms);
  trajectory::LongitudinalState state{0.0F, start.speed_mps, start.acceleration_mps2};
  float there_mps2 = start.acceleration_mps2;  // of the plan where we are: it may have braked for a bend
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const float time_s = static_cast<float>(i) * kStepS;
    const std::uint32_t now_ms = start_ms + static_cast<std::uint32_t>((i - 1) * kStepMs);
    const bool drives_on = time_s <= branch_s + kRoundingS;
    const float slower_mps = sample(running, now_ms).speed_mps - state.speed_mps;
    const float planned_mps2 = sample(running, now_ms + kStepMs).acceleration_mps2;
    const float wanted_mps2 =
        drives_on ? planned_mps2 + kSpeedGain1ps * slower_mps : min(-braking_mps2, there_mps2);
    const float step_m = trajectory::advance(wanted_mps2, parameters, state);
    TrajectoryPoint& point = trajectory.points[i];
    point = trajectory.points[i - 1];
    if (step_m > 0.0F) {
      way_m = way_m + step_m;
      walk.place(way_m, point);
      there_mps2 = point.acceleration_mps2;
      point.rear_axle.x_m = point.rear_axle.x_m + beside.x_m;
      point.rear_axle.y_m = point.rear_axle.y_m + beside.y_m;
    }
    point.speed_mps = state.speed_mps;
    point.acceleration_mps2 = state.acceleration_mps2;
  }
}

void as_steered(const TrajectoryPoint& start, float braking_mps2, Trajectory& trajectory) {
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    trajectory.points[i] = trajectory::bicycle_step(trajectory.points[i - 1], -braking_mps2, 0.0F, kStepS);
  }
}

}  // namespace

void drive_fail_safe(const Plan& running, const TrajectoryPoint& start, std::uint32_t start_ms,
                     float braking_mps2, const Parameters& parameters, Plan& plan) {
  plan.kind = PlanKind::kMinimumRisk;
  plan.start_ms = start_ms;
  plan.fail_safe = {0.0F, braking_mps2};
  const std::int32_t elapsed_ms = static_cast<std::int32_t>(start_ms - running.start_ms);
  const bool covers =
      running.kind != PlanKind::kNone && elapsed_ms >= 0 && elapsed_ms <= kHorizonSteps * kStepMs;
  if (covers) {
    plan.fail_safe.branch_s = max(0.0F, running.fail_safe.branch_s - 1e-3F * static_cast<float>(elapsed_ms));
    along_plan(running, start, start_ms, plan.fail_safe.branch_s, braking_mps2, parameters, plan.trajectory);
    if (trajectory::keeps_limits(plan.trajectory, parameters)) return;
  }
  plan.fail_safe.branch_s = 0.0F;
  as_steered(start, min(braking_mps2, parameters.vehicle.braking_max_mps2), plan.trajectory);
}

}  // namespace s4tp::safety
