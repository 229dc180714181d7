#include "algo/trajectory/optimizer.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kOrdinaryJerkMps3 = 12.0F;  // allowed everywhere; more only where the candidate has it
constexpr float kBoundShare = 0.98F;        // of a limit: the check must pass the result
constexpr float kEndImportance = 5.0F;      // beyond the horizon lies what the candidate was chosen for
constexpr float kInLaneM = 1.0F;            // further from its centre we are on the way to or from it
constexpr float kShiftSlackM = 0.02F;       // so that a candidate further out is not at its bound
constexpr float kComfortGapM = 1.0F;        // nearer than this somebody costs something
constexpr float kStandingM = 0.02F;         // a stop may move this far
constexpr float kTrustM = 0.5F;             // of where the field was evaluated
constexpr float kTrustShare = 0.3F;         // of it, after it led astray
constexpr float kLittleGain = 2e-3F;        // of the cost: not worth evaluating the field again
constexpr float kAtRestMps = 0.01F;         // the smooth clamp's last creep is standstill
constexpr float kRollsOnMps = 0.1F;         // a stop may have so much left at its end

void set_weights(const Parameters& parameters, RefinementWeights& weights) {
  // The score averages squares over the horizon; here it is 1/2 of the sum.
  constexpr float kPerStep = 2.0F / static_cast<float>(kHorizonSteps);
  weights.jerk = kPerStep * parameters.scoring.jerk;
  weights.lateral_jerk = kPerStep * parameters.scoring.jerk;
  weights.lateral = kPerStep * parameters.scoring.lateral_acceleration;
  weights.lane = kPerStep * parameters.scoring.lane_offset;
  weights.curvature_rate = kPerStep * parameters.refinement.curvature_rate;
  weights.along = kPerStep * parameters.refinement.along;
  weights.across = kPerStep * parameters.refinement.across;
  weights.heading = kPerStep * parameters.refinement.heading;
  weights.speed = kPerStep * parameters.refinement.speed;
  weights.over_cap = kPerStep * parameters.refinement.over_cap;
  weights.clearance = kPerStep * parameters.refinement.clearance;
  weights.behind = parameters.scoring.progress;
}

/// Limits, but never narrower than what the trajectory itself asks for.
void set_bounds(const Parameters& parameters, const Trajectory& trajectory, RefinementProblem& problem) {
  const auto& vehicle = parameters.vehicle;
  problem.acceleration_low_mps2 = -kBoundShare * vehicle.braking_max_mps2;
  problem.acceleration_high_mps2 = kBoundShare * vehicle.acceleration_max_mps2;
  problem.curvature_bound_1pm = kBoundShare * curvature_for(vehicle.steering_max_rad, vehicle.wheelbase_m);
  problem.lateral_bound_mps2 = kBoundShare * parameters.comfort.lateral_max_mps2;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& point = trajectory.points[i];
    problem.acceleration_low_mps2 = min(problem.acceleration_low_mps2, point.acceleration_mps2);
    problem.acceleration_high_mps2 = max(problem.acceleration_high_mps2, point.acceleration_mps2);
    problem.curvature_bound_1pm = max(problem.curvature_bound_1pm, abs(point.curvature_1pm));
    problem.lateral_bound_mps2 =
        max(problem.lateral_bound_mps2, square(point.speed_mps) * abs(point.curvature_1pm));
  }
  problem.comfort_gap_m = kComfortGapM;
  problem.centre_m = rear_axle_to_centre_m(parameters);
  problem.half_length_m = 0.5F * vehicle.length_m;
  problem.half_width_m = 0.5F * vehicle.width_m;
}

/// Positions relative to `origin`, headings going on from the one before.
MotionState state_of(const TrajectoryPoint& point, Point origin, float heading_before_rad) {
  MotionState state;
  state.x_m = point.rear_axle.x_m - origin.x_m;
  state.y_m = point.rear_axle.y_m - origin.y_m;
  state.heading_rad = heading_before_rad + wrap_angle(point.rear_axle.heading_rad - heading_before_rad);
  state.speed_mps = point.speed_mps;
  state.acceleration_mps2 = point.acceleration_mps2;
  state.curvature_1pm = point.curvature_1pm;
  return state;
}

void set_reference(const Parameters& parameters, const MotionState& before, const MotionState& reference,
                   RefinementStep& step) {
  const auto& vehicle = parameters.vehicle;
  const SinCos heading = sin_cos(reference.heading_rad);
  step.reference = reference;
  step.along_x = heading.cos;
  step.along_y = heading.sin;
  step.along_bound_m = min(kRefinedAlongM, kRefinedWithinS * reference.speed_mps + kStandingM);
  // d(atan(L kappa))/dt = L kappa' / (1 + L^2 kappa^2)
  const float bend = vehicle.wheelbase_m * before.curvature_1pm;
  const float steering_1pms = vehicle.steering_rate_max_radps * (1.0F + square(bend)) / vehicle.wheelbase_m;
  step.input_bound.jerk_mps3 =
      max(kOrdinaryJerkMps3, abs(reference.acceleration_mps2 - before.acceleration_mps2) / kStepS);
  step.input_bound.curvature_rate_1pms =
      max(steering_1pms, abs(reference.curvature_1pm - before.curvature_1pm) / kStepS);
}

/// The field pushes us aside from a vehicle that drives beside us, for as long as it does. In the lane it may
/// do so a little, and never further out than the candidate is: else each plan would begin where the last
/// one pushed. On the way to another lane or back the decision stands.
void set_across_bounds(float offset_m, RefinementStep& step) {
  const bool in_lane = abs(offset_m) < kInLaneM;
  const float most_m = max(kRefinedInLaneM, abs(offset_m)) + kShiftSlackM;
  step.across_low_m = in_lane ? -most_m - offset_m : -kOnTheWayM;
  step.across_high_m = in_lane ? most_m - offset_m : kOnTheWayM;
}

void write_back(const Motion& motion, Point origin, Trajectory& trajectory) {
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const MotionState& state = motion.states[i];
    TrajectoryPoint& point = trajectory.points[i];
    const bool rests = state.speed_mps < kAtRestMps;
    if (rests && trajectory.points[i - 1].speed_mps <= 0.0F) {
      point.rear_axle = trajectory.points[i - 1].rear_axle;
    } else {
      point.rear_axle = {state.x_m + origin.x_m, state.y_m + origin.y_m, wrap_angle(state.heading_rad)};
    }
    point.curvature_1pm = state.curvature_1pm;
    point.speed_mps = rests ? 0.0F : state.speed_mps;
    point.acceleration_mps2 = rests ? 0.0F : state.acceleration_mps2;
  }
}

/// Whether a candidate that comes to rest does not any more.
bool rolls_on(const Trajectory& candidate, const Trajectory& refined) {
  return candidate.points[kHorizonSteps].speed_mps <= 0.0F &&
         refined.points[kHorizonSteps].speed_mps >= kRollsOnMps;
}

}  // namespace

void build_refinement(const ReferenceLine& line, float start_s_m, const Surroundings& surroundings,
                      const Parameters& parameters, const Trajectory& trajectory,
                      RefinementProblem& problem) {
  const TrajectoryPoint& start = trajectory.points[0];
  const Point origin = position(start.rear_axle);
  set_weights(parameters, problem.weights);
  set_bounds(parameters, trajectory, problem);
  without_field(problem);
  problem.start = state_of(start, origin, start.rear_axle.heading_rad);
  ReferenceCoordinates where = locate_on(line, origin, start_s_m);
  for (int i = 0; i < kHorizonSteps; ++i) {
    const TrajectoryPoint& point = trajectory.points[i + 1];
    RefinementStep& step = problem.steps[i];
    const MotionState& before = i > 0 ? problem.steps[i - 1].reference : problem.start;
    set_reference(parameters, before, state_of(point, origin, before.heading_rad), step);
    where = locate_on(line, position(point.rear_axle), where.s_m + kStepS * point.speed_mps);
    const float offset_m = where.d_m - line.lateral_offset_m;
    step.lane_offset_m = abs(offset_m) < kInLaneM ? offset_m : 0.0F;
    set_across_bounds(offset_m, step);
    step.speed_cap_mps = max(reference_at(line, where.s_m).speed_cap_mps, point.speed_mps);
    step.curvature_rate_weight =
        problem.weights.curvature_rate + problem.weights.lateral_jerk * square(square(point.speed_mps));
  }
  problem.end_importance = kEndImportance;
  find_half_planes(surroundings, trajectory, origin, kComfortGapM + kRefinedAlongM, parameters, problem);
}

bool Optimizer::solve(const RefinementProblem& problem, RefinementAllowance allowance, Motion& motion,
                      RefinementResult& result) {
  const int left = allowance.passes - passes_spent(result.passes, result.failed_trials);
  if (left <= 0) return false;
  const IlqrResult found = ilqr_.solve(problem, left, motion);
  result.passes += found.passes;
  result.failed_trials += found.failed_trials;
  return found.improved;
}

bool Optimizer::evaluate(const Surroundings& surroundings, const RefinementProblem& problem, Point origin,
                         const Parameters& parameters, RefinementAllowance allowance, const Motion& motion,
                         RefinementResult& result, FieldAlong& field, float& cost) {
  const int to_come = allowance.evaluations - result.evaluations;
  if (to_come <= 0) return false;
  const std::int32_t share = (allowance.field_work - result.field_work) / to_come;
  if (share < kLeastFieldWork) return false;
  WorkMeter work{share};
  cost = evaluate_field(surroundings, problem, origin, motion, parameters, work, scratch_, field);
  ++result.evaluations;
  result.field_work += share - work.left;
  return true;
}

void Optimizer::improve_in_field(const Surroundings& surroundings, const Parameters& parameters, Point origin,
                                 RefinementAllowance allowance, RefinementProblem& problem, Motion& motion,
                                 RefinementResult& result) {
  float cost = result.own_before + result.field_before;
  float trust_m = kTrustM;
  best_ = motion;
  for (int round = 0; round < allowance.passes; ++round) {
    put_field(field_, best_, trust_m, parameters, problem);
    if (!solve(problem, allowance, motion, result)) break;
    const Judgement judgement = judge_motion(problem, motion);
    float field = judgement.field;
    const bool last =
        !evaluate(surroundings, problem, origin, parameters, allowance, motion, result, along_, field);
    const float gain = cost - (judgement.own + field);
    if (gain <= 0.0F) {
      motion = best_;
      trust_m *= kTrustShare;
      if (last) break;
      continue;
    }
    best_ = motion;
    field_ = along_;
    trust_m = kTrustM;
    cost -= gain;
    result.own_after = judgement.own;
    result.field_after = field;
    result.improved = true;
    if (last || gain <= kLittleGain * cost) break;
  }
}

RefinementResult Optimizer::improve(const Surroundings& surroundings, const Parameters& parameters,
                                    Point origin, RefinementAllowance allowance, RefinementProblem& problem,
                                    Motion& motion) {
  RefinementResult result;
  if (allowance.passes <= 0) return result;
  result.own_before = judge_motion(problem, motion).own;
  result.own_after = result.own_before;
  if (evaluate(surroundings, problem, origin, parameters, allowance, motion, result, field_,
               result.field_before)) {
    result.field_after = result.field_before;
  }
  if (result.field_before > 0.0F) {
    improve_in_field(surroundings, parameters, origin, allowance, problem, motion, result);
    return result;
  }
  result.evaluations = 0;
  if (solve(problem, allowance, motion, result)) {
    result.improved = true;
    result.own_after = judge_motion(problem, motion).own;
  }
  return result;
}

RefinementResult Optimizer::refine(const ReferenceLine& line, float start_s_m,
                                   const Surroundings& surroundings, const Parameters& parameters,
                                   RefinementAllowance allowance, const Trajectory& candidate,
                                   Trajectory& refined) {
  refined = candidate;
  if (allowance.passes <= 0) return {};
  build_refinement(line, start_s_m, surroundings, parameters, candidate, problem_);
  reference_motion(problem_, motion_);
  const Point origin = position(candidate.points[0].rear_axle);
  RefinementResult result = improve(surroundings, parameters, origin, allowance, problem_, motion_);
  if (!result.improved) return result;
  write_back(motion_, origin, refined);
  if (!feasible(refined, parameters) || rolls_on(candidate, refined)) {
    refined = candidate;
    result.improved = false;
  }
  return result;
}

}  // namespace s4tp::trajectory
