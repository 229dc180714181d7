#include "firmware/ecu/tracker.hpp"

#include "algo/core/math.hpp"

namespace s4tp::ecu {
namespace {

constexpr float kTickS = 0.01F;
constexpr float kDriveJerkMps3 = 10.0F;    // building up drive, and leaving a standstill
constexpr float kReleaseJerkMps3 = 20.0F;  // of the brakes: what the gate lets through
constexpr float kFeedbackMaxMps2 = 3.0F;
constexpr float kTrimMaxMps2 = 1.0F;
constexpr float kTrimMax1pm = 0.01F;  // 0.03 rad of steering at a 2.9 m wheelbase
constexpr float kBesideMaxM = 3.0F;
constexpr float kBehindMaxM = 2.0F;
constexpr float kShortestStepM = 0.1F;
constexpr float kPlanStandsMps = 0.05F;  // a plan this slow stands
constexpr float kHoldBelowMps = 0.2F;    // the brake may take over from here
constexpr float kTrimRate1ps3 = 0.1F;   // along: a third of the limit of stability, speed_gain * station_gain
constexpr float kTrimCrossMaxM = 0.3F;  // further off is a manoeuvre, not a bias
constexpr float kTrimAlongMaxM = 2.0F;
constexpr float kCurvatureTrimShare = 0.05F;  // across: of that limit, 2 / w^3

/// Where the car is on a plan's path: the nearest point, and its place in the plan as a fractional index.
/// Behind the start the path goes on backwards with the first point's curvature: a car a little late is not
/// off it.
struct Place {
  TrajectoryPoint point;
  float index = 0.0F;
};

TrajectoryPoint at_index(const Trajectory& trajectory, float index) {
  const float inside = clamp(index, 0.0F, static_cast<float>(kHorizonSteps));
  const int i = to_int(floor(inside), 0, kHorizonSteps - 1);
  return interpolate(trajectory.points[i], trajectory.points[i + 1], inside - static_cast<float>(i));
}

Place nearest(const Trajectory& trajectory, Point car) {
  float best_index = 0.0F;
  float best =
      dot(car - position(trajectory.points[0].rear_axle), car - position(trajectory.points[0].rear_axle));
  for (int i = 0; i < kHorizonSteps; ++i) {
    const Point from = position(trajectory.points[i].rear_axle);
    const Point way = position(trajectory.points[i + 1].rear_axle) - from;
    const float length_squared = dot(way, way);
    if (length_squared < 1e-6F) continue;
    const float t = clamp(dot(car - from, way) / length_squared, 0.0F, 1.0F);
    const Point apart = car - (from + t * way);
    const float squared = dot(apart, apart);
    if (squared < best) {
      best = squared;
      best_index = static_cast<float>(i) + t;
    }
  }
  Place place{at_index(trajectory, best_index), best_index};
  const Pose start = place.point.rear_axle;
  const float behind_m = clamp(-to_local(start, car).x_m, 0.0F, kBehindMaxM);
  if (best_index > 0.0F || behind_m <= 0.0F) return place;
  const float turned_rad = place.point.curvature_1pm * behind_m;
  const Point back = behind_m * direction(start.heading_rad - 0.5F * turned_rad);
  const Point there = position(start) - back;
  place.point.rear_axle = {there.x_m, there.y_m, wrap_angle(start.heading_rad - turned_rad)};
  place.index = -behind_m / max(place.point.speed_mps * kStepS, kShortestStepM);
  return place;
}

/// From the plan's start to its fail-safe's branch.
std::int32_t branch_ms(const Plan& plan) {
  return to_int(1000.0F * plan.fail_safe.branch_s, 0, kHorizonSteps * kStepMs);
}

/// Geometry and the tyres' share.
float steering_for_curvature(float curvature_1pm, float speed_mps, const Parameters& parameters) {
  const float bound = parameters.vehicle.steering_max_rad;
  const float tyres_rad = parameters.tracking.understeer * square(speed_mps) * curvature_1pm;
  return clamp(atan(parameters.vehicle.wheelbase_m * curvature_1pm) + tyres_rad, -bound, bound);
}

}  // namespace

void Tracker::reset(float acceleration_mps2) {
  *this = Tracker{};
  acceleration_mps2_ = acceleration_mps2;
}

gate::Command Tracker::follow(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                              const Parameters& parameters) {
  const auto elapsed_ms = static_cast<std::int32_t>(now_ms - plan.start_ms);
  // A stop is followed to its end; a plan to drive only as far as the guard's fail-safe counts on.
  const bool has_branch = plan.kind == PlanKind::kDrive && plan.fail_safe.braking_mps2 > 0.0F;
  const std::int32_t last_ms = has_branch ? branch_ms(plan) : kHorizonSteps * kStepMs;
  if (plan.kind == PlanKind::kNone || elapsed_ms > last_ms) return stop(plan, ego, parameters);
  const TrajectoryPoint now = sample(plan, now_ms);
  const Point offset = to_local(now.rear_axle, position(ego.rear_axle));
  error_ = {offset.x_m, offset.y_m, norm(offset)};
  gate::Command command;
  command.steering_rad = steer(plan, ego, parameters);
  command.acceleration_mps2 = drive(plan, now_ms, ego, parameters);
  acceleration_mps2_ = command.acceleration_mps2;
  return command;
}

gate::Command Tracker::drive_fail_safe(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                                       const Parameters& parameters) {
  const auto elapsed_ms = static_cast<std::int32_t>(now_ms - plan.start_ms);
  if (elapsed_ms < branch_ms(plan)) return follow(plan, now_ms, ego, parameters);
  return stop(plan, ego, parameters);
}

gate::Command Tracker::stop(const Plan& last, const EgoState& ego, const Parameters& parameters) {
  error_ = {};
  acceleration_trim_mps2_ = 0.0F;
  const float braking_mps2 = max(parameters.safety.minimum_risk_braking_mps2, last.fail_safe.braking_mps2);
  gate::Command command{-braking_mps2, ego.steering_rad};
  if (last.kind != PlanKind::kNone) {
    const Place place = nearest(last.trajectory, position(ego.rear_axle));
    const float beside_m = abs(to_local(place.point.rear_axle, position(ego.rear_axle)).y_m);
    if (beside_m <= kBesideMaxM) {
      command.steering_rad = steer(last, ego, parameters);
      command.acceleration_mps2 = min(command.acceleration_mps2, place.point.acceleration_mps2);
    }
  }
  acceleration_mps2_ = command.acceleration_mps2;
  holding_ = ego.speed_mps < kHoldBelowMps;
  return command;
}

float Tracker::steer(const Plan& plan, const EgoState& ego, const Parameters& parameters) {
  const Place place = nearest(plan.trajectory, position(ego.rear_axle));
  const float cross_m = to_local(place.point.rear_axle, position(ego.rear_axle)).y_m;
  // In a turn the rear axle slips outwards: the car points inwards of where it goes.
  const float slip_rad = parameters.tracking.rear_slip * ego.speed_mps * ego.yaw_rate_radps;
  const float course_rad = ego.rear_axle.heading_rad - slip_rad;
  const float turned_rad = wrap_angle(course_rad - place.point.rear_axle.heading_rad);
  const float way_m =
      max(parameters.tracking.convergence_m, ego.speed_mps * parameters.tracking.convergence_s);
  const float ahead = parameters.tracking.steering_delay_s / kStepS;
  const float planned_1pm = at_index(plan.trajectory, place.index + ahead).curvature_1pm;
  const float feedback_1pm = -(cross_m / way_m + 2.0F * turned_rad) / way_m;
  const float curvature_1pm = planned_1pm + feedback_1pm + curvature_trim_1pm_;
  const float steering_rad = steering_for_curvature(curvature_1pm, ego.speed_mps, parameters);

  const bool saturated = abs(steering_rad) >= parameters.vehicle.steering_max_rad;
  if (!saturated && ego.speed_mps > 1.0F && abs(cross_m) < kTrimCrossMaxM) {
    const float rate = kCurvatureTrimShare * 2.0F / (way_m * way_m * way_m);
    curvature_trim_1pm_ =
        clamp(curvature_trim_1pm_ - rate * cross_m * ego.speed_mps * kTickS, -kTrimMax1pm, kTrimMax1pm);
  }
  return steering_rad;
}

float Tracker::drive(const Plan& plan, std::uint32_t now_ms, const EgoState& ego,
                     const Parameters& parameters) {
  const TrajectoryPoint now = sample(plan, now_ms);
  const std::uint32_t delay_ms =
      static_cast<std::uint32_t>(to_int(1000.0F * parameters.tracking.drive_delay_s, 0, 1000));
  const TrajectoryPoint next = sample(plan, now_ms + delay_ms);
  const bool plan_stands = now.speed_mps < kPlanStandsMps && next.speed_mps < kPlanStandsMps;
  holding_ = plan_stands && (holding_ || ego.speed_mps < kHoldBelowMps);
  if (holding_) {
    acceleration_trim_mps2_ = 0.0F;
    return -parameters.tracking.hold_braking_mps2;
  }

  const float behind_m = -error_.along_m;
  const float slower_mps = now.speed_mps - ego.speed_mps;
  const float feedback_mps2 =
      clamp(parameters.tracking.station_gain * behind_m + parameters.tracking.speed_gain * slower_mps,
            -kFeedbackMaxMps2, kFeedbackMaxMps2);
  const float wanted_mps2 = next.acceleration_mps2 + feedback_mps2 + acceleration_trim_mps2_;
  const bool releases = acceleration_mps2_ < 0.0F && ego.speed_mps > kHoldBelowMps;
  const float rise_mps2 = (releases ? kReleaseJerkMps3 : kDriveJerkMps3) * kTickS;
  const float highest_mps2 = min(parameters.vehicle.acceleration_max_mps2, acceleration_mps2_ + rise_mps2);
  const float asked_mps2 = clamp(wanted_mps2, -parameters.vehicle.braking_max_mps2,
                                 max(highest_mps2, -parameters.vehicle.braking_max_mps2));
  if (asked_mps2 == wanted_mps2 && ego.speed_mps > 1.0F && abs(behind_m) < kTrimAlongMaxM) {
    acceleration_trim_mps2_ =
        clamp(acceleration_trim_mps2_ + kTrimRate1ps3 * behind_m * kTickS, -kTrimMaxMps2, kTrimMaxMps2);
  }
  return asked_mps2;
}

}  // namespace s4tp::ecu
