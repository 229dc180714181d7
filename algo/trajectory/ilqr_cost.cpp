#include "algo/core/inline.hpp"
#include "algo/trajectory/ilqr_model.hpp"

namespace s4tp::trajectory {
namespace {

/// How much of each bounded quantity matters as much as the others: penalties grow with 1 / unit^2.
namespace bound_units {
constexpr float kAlongM = 0.2F;
constexpr float kAcrossM = 0.2F;
constexpr float kAccelerationMps2 = 1.0F;
constexpr float kCurvature1pm = 0.02F;
constexpr float kLateralMps2 = 1.0F;
constexpr float kGapM = 0.1F;
}  // namespace bound_units

constexpr float kNoUpperBound = 1e9F;

/// What bounded or weighted quantities depend on the pose in a less than trivial way.
struct Residuals {
  float along_m;
  float across_m;
  float heading_rad;
  float lateral_mps2;
  float field;
  float gap_m[kMaxHalfPlanes];
  float gap_by_heading[kMaxHalfPlanes];
};

void find_gaps(const RefinementProblem& problem, const RefinementStep& step, const MotionState& state,
               Residuals& residuals) {
  if (step.half_plane_count == 0) return;
  const SinCos heading = sin_cos(state.heading_rad);
  for (int k = 0; k < step.half_plane_count; ++k) {
    const HalfPlane& plane = step.half_planes[k];
    const float ahead = plane.normal_x * heading.cos + plane.normal_y * heading.sin;
    const float left = plane.normal_y * heading.cos - plane.normal_x * heading.sin;
    residuals.gap_m[k] = plane.normal_x * state.x_m + plane.normal_y * state.y_m + problem.centre_m * ahead -
                         plane.offset_m - problem.half_length_m * abs(ahead) -
                         problem.half_width_m * abs(left);
    // d ahead = left, d left = -ahead
    residuals.gap_by_heading[k] = problem.centre_m * left -
                                  problem.half_length_m * (ahead < 0.0F ? -left : left) +
                                  problem.half_width_m * (left < 0.0F ? -ahead : ahead);
  }
}

float field_at(const FieldResidual& field, const MotionState& state) {
  return field.offset + field.by_x * state.x_m + field.by_y * state.y_m +
         field.by_heading * state.heading_rad + field.by_speed * state.speed_mps +
         field.by_curvature * state.curvature_1pm;
}

Residuals find_residuals(const RefinementProblem& problem, const RefinementStep& step,
                         const MotionState& state) {
  Residuals residuals;
  const Deviation deviation = deviation_of(step, state);
  residuals.along_m = deviation.along_m;
  residuals.across_m = deviation.across_m;
  residuals.heading_rad =
      state.heading_rad - step.reference.heading_rad - step.reference.curvature_1pm * residuals.along_m;
  residuals.lateral_mps2 = square(state.speed_mps) * state.curvature_1pm;
  residuals.field = field_at(step.field, state);
  find_gaps(problem, step, state, residuals);
  return residuals;
}

/// Cost of one residual with its derivatives by it.
struct Pull {
  float cost = 0.0F;
  float slope = 0.0F;
  float stiffness = 0.0F;

  void square_of(float residual, float weight) {
    cost += 0.5F * weight * square(residual);
    slope += weight * residual;
    stiffness += weight;
  }
  /// Only what is negative costs: its square up to `blend`, then evenly.
  void shortfall_of(float residual, float blend, float weight) {
    if (residual >= 0.0F || weight <= 0.0F) return;
    const float lacking = min(-residual, blend);
    cost += weight * (lacking * lacking / (2.0F * blend) + (-residual - lacking));
    slope -= weight * lacking / blend;
    if (lacking < blend) stiffness += weight / blend;
  }
  /// Only what is positive costs.
  void excess_of(float residual, float weight) {
    if (residual > 0.0F) square_of(residual, weight);
  }
};

/// low <= residual <= high by an augmented Lagrangian.
struct Bound {
  float low;
  float high;
  float multiplier;
  float penalty;

  /// How far the shifted residual lies outside: what pushes back.
  [[nodiscard]] float push(float residual) const {
    const float shifted = residual + multiplier / penalty;
    return shifted < low ? shifted - low : (shifted > high ? shifted - high : 0.0F);
  }
  void add_to(float residual, Pull& pull) const {
    if (penalty <= 0.0F) return;
    const float outside = push(residual);
    if (outside != 0.0F) pull.square_of(outside, penalty);
  }
};

constexpr float per_square(float unit) {
  return 1.0F / (unit * unit);
}

/// The bounds of one step, in a fixed order. `visit(bound, residual, index)`; index counts the kinds and then
/// the gaps.
enum Kind { kAlong = 0, kAcross, kAcceleration, kCurvature, kLateral, kGap };

struct Range {
  float low;
  float high;
};

/// What both bounds leave.
Range trust_region(float centre, float trust, float low, float high) {
  return {max(centre - trust, low), min(centre + trust, high)};
}

Bound bound_of(const RefinementProblem& problem, const RefinementStep& step,
               const BoundMultipliers& multipliers, float penalty, Kind kind, int gap = 0) {
  namespace units = bound_units;
  switch (kind) {
    case kAlong: {
      const Range range =
          trust_region(step.trusted_along_m, problem.trust_m, -step.along_bound_m, step.along_bound_m);
      return {range.low, range.high, multipliers.along, penalty * per_square(units::kAlongM)};
    }
    case kAcross: {
      const Range range =
          trust_region(step.trusted_across_m, problem.trust_m, step.across_low_m, step.across_high_m);
      return {range.low, range.high, multipliers.across, penalty * per_square(units::kAcrossM)};
    }
    case kAcceleration:
      return {problem.acceleration_low_mps2, problem.acceleration_high_mps2, multipliers.acceleration,
              penalty * per_square(units::kAccelerationMps2)};
    case kCurvature:
      return {-problem.curvature_bound_1pm, problem.curvature_bound_1pm, multipliers.curvature,
              penalty * per_square(units::kCurvature1pm)};
    case kLateral:
      return {-problem.lateral_bound_mps2, problem.lateral_bound_mps2, multipliers.lateral,
              penalty * per_square(units::kLateralMps2)};
    case kGap:
      break;
  }
  return {step.half_planes[gap].least_gap_m, kNoUpperBound, multipliers.gap[gap],
          penalty * per_square(units::kGapM)};
}

/// All residuals' pulls.
struct StepPulls {
  Pull along;
  Pull across;
  Pull heading;
  Pull speed;
  Pull acceleration;
  Pull curvature;
  Pull lateral;
  Pull gap[kMaxHalfPlanes];
};

/// \return the sum of their costs
inline float pull_all(const RefinementProblem& problem, const BoundState& bounds, int index,
                      const Residuals& residuals, const MotionState& state, StepPulls& pulls) {
  const RefinementStep& step = problem.steps[index];
  const RefinementWeights& weights = problem.weights;
  const BoundMultipliers& multipliers = bounds.multipliers[index];
  const float penalty = bounds.penalty;
  const float importance = index == kHorizonSteps - 1 ? problem.end_importance : 1.0F;
  const auto bound = [&](Kind kind, int gap = 0) {
    return bound_of(problem, step, multipliers, penalty, kind, gap);
  };
  pulls.along.square_of(residuals.along_m, importance * weights.along);
  if (index == kHorizonSteps - 1) {
    pulls.along.shortfall_of(residuals.along_m, kBehindBlendM, weights.behind);
  }
  bound(kAlong).add_to(residuals.along_m, pulls.along);
  pulls.across.square_of(residuals.across_m, importance * weights.across);
  pulls.across.square_of(step.lane_offset_m + residuals.across_m, weights.lane);
  bound(kAcross).add_to(residuals.across_m, pulls.across);
  pulls.heading.square_of(residuals.heading_rad, importance * weights.heading);
  pulls.speed.square_of(state.speed_mps - step.reference.speed_mps, importance * weights.speed);
  pulls.speed.excess_of(state.speed_mps - step.speed_cap_mps, weights.over_cap);
  bound(kAcceleration).add_to(state.acceleration_mps2, pulls.acceleration);
  bound(kCurvature).add_to(state.curvature_1pm, pulls.curvature);
  pulls.lateral.square_of(residuals.lateral_mps2, weights.lateral);
  bound(kLateral).add_to(residuals.lateral_mps2, pulls.lateral);
  float cost = pulls.along.cost + pulls.across.cost + pulls.heading.cost + pulls.speed.cost +
               pulls.acceleration.cost + pulls.curvature.cost + pulls.lateral.cost;
  for (int k = 0; k < step.half_plane_count; ++k) {
    Pull& pull = pulls.gap[k];
    const float lacking_m = problem.comfort_gap_m - residuals.gap_m[k];
    if (lacking_m > 0.0F) {
      pull.cost = 0.5F * weights.clearance * square(lacking_m);
      pull.slope = -weights.clearance * lacking_m;
      pull.stiffness = weights.clearance;
    }
    bound(kGap, k).add_to(residuals.gap_m[k], pull);
    cost += pull.cost;
  }
  return cost;
}

/// Adds a residual's cost; `direction` is its gradient by the state's entries from `Begin` on.
template <int Begin, int Size>
void add_pull(const Pull& pull, const Vector<Size>& direction, StateCost& cost) {
  cost.gradient.segment<Size>(Begin) += pull.slope * direction;
  cost.hessian.block<Size, Size>(Begin, Begin) += (pull.stiffness * direction) * direction.transpose();
}

float cost_of_input(const RefinementProblem& problem, const RefinementStep& step, const MotionInput& input) {
  return 0.5F * (problem.weights.jerk * square(input.jerk_mps3) +
                 step.curvature_rate_weight * square(input.curvature_rate_1pms));
}

float outside(float value, float low, float high, float unit) {
  return max(low - value, value - high) / unit;
}

float worst_violation(const RefinementProblem& problem, const RefinementStep& step,
                      const Residuals& residuals, const MotionState& state) {
  namespace units = bound_units;
  const Range along =
      trust_region(step.trusted_along_m, problem.trust_m, -step.along_bound_m, step.along_bound_m);
  const Range across =
      trust_region(step.trusted_across_m, problem.trust_m, step.across_low_m, step.across_high_m);
  float worst = outside(residuals.along_m, along.low, along.high, units::kAlongM);
  worst = max(worst, outside(residuals.across_m, across.low, across.high, units::kAcrossM));
  worst = max(worst, outside(state.acceleration_mps2, problem.acceleration_low_mps2,
                             problem.acceleration_high_mps2, units::kAccelerationMps2));
  worst = max(worst, outside(state.curvature_1pm, -problem.curvature_bound_1pm, problem.curvature_bound_1pm,
                             units::kCurvature1pm));
  worst = max(worst, outside(residuals.lateral_mps2, -problem.lateral_bound_mps2, problem.lateral_bound_mps2,
                             units::kLateralMps2));
  for (int k = 0; k < step.half_plane_count; ++k) {
    worst = max(worst, (step.half_planes[k].least_gap_m - residuals.gap_m[k]) / units::kGapM);
  }
  return worst;
}

}  // namespace

Deviation deviation_of(const RefinementStep& step, const MotionState& state) {
  const float dx = state.x_m - step.reference.x_m;
  const float dy = state.y_m - step.reference.y_m;
  const float along_m = step.along_x * dx + step.along_y * dy;
  return {along_m,
          (step.along_x * dy - step.along_y * dx) - 0.5F * step.reference.curvature_1pm * square(along_m)};
}

Judgement judge_motion(const RefinementProblem& problem, const Motion& motion) {
  static constexpr BoundState kNoBounds{};
  Judgement judgement;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const RefinementStep& step = problem.steps[i];
    const MotionState& state = motion.states[i + 1];
    const Residuals residuals = find_residuals(problem, step, state);
    StepPulls pulls;
    judgement.own += pull_all(problem, kNoBounds, i, residuals, state, pulls) +
                     cost_of_input(problem, step, motion.inputs[i]);
    judgement.field += 0.5F * square(residuals.field);
    judgement.violation = max(judgement.violation, worst_violation(problem, step, residuals, state));
  }
  judgement.field -= problem.field_constant;
  return judgement;
}

float step_merit(const RefinementProblem& problem, const BoundState& bounds, int index,
                 const MotionInput& input, const MotionState& state) {
  const RefinementStep& step = problem.steps[index];
  const Residuals residuals = find_residuals(problem, step, state);
  StepPulls pulls;
  return pull_all(problem, bounds, index, residuals, state, pulls) + 0.5F * square(residuals.field) +
         cost_of_input(problem, step, input);
}

void add_step_cost(const RefinementProblem& problem, const BoundState& bounds, int index,
                   const MotionState& state, StateCost& cost) {
  const RefinementStep& step = problem.steps[index];
  const Residuals residuals = find_residuals(problem, step, state);
  StepPulls pulls;
  (void)pull_all(problem, bounds, index, residuals, state, pulls);

  // along by t, across by n - kappa along t, heading by psi - kappa along.
  const float bend = step.reference.curvature_1pm;
  const Vector<2> along = {step.along_x, step.along_y};
  const Vector<2> left = {-step.along_y, step.along_x};
  add_pull<0>(pulls.along, along, cost);
  add_pull<0>(pulls.across, Vector<2>(left - (bend * residuals.along_m) * along), cost);
  add_pull<0>(pulls.heading, Vector<3>(-bend * along.x(), -bend * along.y(), 1.0F), cost);
  for (int k = 0; k < step.half_plane_count; ++k) {
    const HalfPlane& plane = step.half_planes[k];
    add_pull<0>(pulls.gap[k], Vector<3>(plane.normal_x, plane.normal_y, residuals.gap_by_heading[k]), cost);
  }
  const float lateral_by_speed = 2.0F * state.speed_mps * state.curvature_1pm;
  add_pull<kV>(pulls.lateral, Vector<3>(lateral_by_speed, 0.0F, square(state.speed_mps)), cost);
  add_pull<kV>(pulls.speed, Vector<1>(1.0F), cost);
  add_pull<kA>(pulls.acceleration, Vector<1>(1.0F), cost);
  add_pull<kKappa>(pulls.curvature, Vector<1>(1.0F), cost);
  if (residuals.field != 0.0F) {
    const FieldResidual& field = step.field;
    const StateVector slope =
        (StateVector() << field.by_x, field.by_y, field.by_heading, field.by_speed, 0.0F, field.by_curvature)
            .finished();
    add_pull<0>(Pull{0.0F, residuals.field, 1.0F}, slope, cost);
  }
}

InputCost input_cost(const RefinementProblem& problem, int index, const MotionInput& input) {
  const InputVector weights = {problem.weights.jerk, problem.steps[index].curvature_rate_weight};
  return {weights.cwiseProduct(vector_of(input)), weights};
}

void update_multipliers(const RefinementProblem& problem, const Motion& motion, BoundState& bounds) {
  for (int i = 0; i < kHorizonSteps; ++i) {
    const RefinementStep& step = problem.steps[i];
    const MotionState& state = motion.states[i + 1];
    const Residuals residuals = find_residuals(problem, step, state);
    BoundMultipliers& multipliers = bounds.multipliers[i];
    const auto renew = [&](float& multiplier, float residual, Kind kind, int gap = 0) {
      const Bound bound = bound_of(problem, step, multipliers, bounds.penalty, kind, gap);
      multiplier = bound.penalty * bound.push(residual);
    };
    renew(multipliers.along, residuals.along_m, kAlong);
    renew(multipliers.across, residuals.across_m, kAcross);
    renew(multipliers.acceleration, state.acceleration_mps2, kAcceleration);
    renew(multipliers.curvature, state.curvature_1pm, kCurvature);
    renew(multipliers.lateral, residuals.lateral_mps2, kLateral);
    for (int k = 0; k < step.half_plane_count; ++k) renew(multipliers.gap[k], residuals.gap_m[k], kGap, k);
  }
}

}  // namespace s4tp::trajectory
