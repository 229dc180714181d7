#include "algo/trajectory/refinement_field.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/risk.hpp"

namespace s4tp::trajectory {
namespace {

/// R_0: keeps the root from falling steeply where there is hardly any risk.
constexpr float kRootOffset = 500.0F;

/// At inner steps a knot's value and half the ways to its neighbours' are counted kFieldStride times in all;
/// before the first knot the field counts as it is there.
FieldKnot between(const FieldAlong& field, int index) {
  const int after = index / kFieldStride;
  const int since = index - (after * kFieldStride - 1);  // steps since the knot before
  const FieldKnot& to = field.knots[after];
  if (after == 0 || since == kFieldStride) return to;
  const FieldKnot& from = field.knots[after - 1];
  const float share = static_cast<float>(since) / static_cast<float>(kFieldStride);
  return {lerp(from.risk, to.risk, share),           lerp(from.by_along, to.by_along, share),
          lerp(from.by_across, to.by_across, share), lerp(from.by_heading, to.by_heading, share),
          lerp(from.by_speed, to.by_speed, share),   lerp(from.by_curvature, to.by_curvature, share)};
}

float step_weight(const Parameters& parameters) {
  return parameters.scoring.risk * kStepS;
}

}  // namespace

float evaluate_field(const Surroundings& surroundings, const RefinementProblem& problem, Point origin,
                     const Motion& motion, const Parameters& parameters, WorkMeter& work,
                     FieldScratch& scratch, FieldAlong& field) {
  work.spend(kLeastFieldWork);
  Trajectory& trajectory = scratch.trajectory;
  for (int i = kFieldStride - 1; i < kHorizonSteps; i += kFieldStride) {
    const MotionState& state = motion.states[i + 1];
    TrajectoryPoint& point = trajectory.points[i + 1];
    point.rear_axle = {state.x_m + origin.x_m, state.y_m + origin.y_m, wrap_angle(state.heading_rad)};
    point.speed_mps = state.speed_mps;
    point.curvature_1pm = state.curvature_1pm;
  }
  sadrf::SmoothRisk(&risks)[kHorizonSteps] = scratch.risks;
  sadrf::smooth_risk(surroundings.scene, surroundings.conditioned, surroundings.constant_velocity, trajectory,
                     parameters, kFieldStride - 1, kFieldStride, risks, work);
  const float wheelbase_m = parameters.vehicle.wheelbase_m;
  for (int k = 0; k < kFieldKnots; ++k) {
    const int i = k * kFieldStride + kFieldStride - 1;
    const RefinementStep& step = problem.steps[i];
    const sadrf::FieldGradient& slope = risks[i].slope;
    const float bend = wheelbase_m * motion.states[i + 1].curvature_1pm;
    field.knots[k] = {risks[i].value,
                      step.along_x * slope.x + step.along_y * slope.y,
                      step.along_x * slope.y - step.along_y * slope.x,
                      slope.heading,
                      slope.speed,
                      slope.steering * wheelbase_m / (1.0F + square(bend))};
  }
  float sum = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) sum += between(field, i).risk;
  return step_weight(parameters) * sum;
}

void without_field(RefinementProblem& problem) {
  problem.trust_m = kTrustAll;
  problem.field_constant = 0.0F;
  for (RefinementStep& step : problem.steps) {
    step.field = FieldResidual{};
    step.trusted_along_m = 0.0F;
    step.trusted_across_m = 0.0F;
  }
}

void put_field(const FieldAlong& field, const Motion& motion, float trust_m, const Parameters& parameters,
               RefinementProblem& problem) {
  const float twice_weight = 2.0F * step_weight(parameters);
  problem.trust_m = trust_m;
  problem.field_constant = 0.5F * twice_weight * kRootOffset * static_cast<float>(kHorizonSteps);
  for (int i = 0; i < kHorizonSteps; ++i) {
    RefinementStep& step = problem.steps[i];
    const MotionState& state = motion.states[i + 1];
    const Deviation deviation = deviation_of(step, state);
    step.trusted_along_m = deviation.along_m;
    step.trusted_across_m = deviation.across_m;
    FieldKnot knot = between(field, i);
    if (step.across_high_m >= kOnTheWayM && step.across_low_m <= -kOnTheWayM) {
      knot.by_across = 0.0F;
      knot.by_heading = 0.0F;
      knot.by_curvature = 0.0F;
    }
    const float root = sqrt(twice_weight * (knot.risk + kRootOffset));
    const float per = root > 0.0F ? 0.5F * twice_weight / root : 0.0F;  // w grad R / r
    FieldResidual& residual = step.field;
    residual.by_x = per * (step.along_x * knot.by_along - step.along_y * knot.by_across);
    residual.by_y = per * (step.along_y * knot.by_along + step.along_x * knot.by_across);
    residual.by_heading = per * knot.by_heading;
    residual.by_speed = per * knot.by_speed;
    residual.by_curvature = per * knot.by_curvature;
    residual.offset = root - (residual.by_x * state.x_m + residual.by_y * state.y_m +
                              residual.by_heading * state.heading_rad + residual.by_speed * state.speed_mps +
                              residual.by_curvature * state.curvature_1pm);
  }
}

}  // namespace s4tp::trajectory
