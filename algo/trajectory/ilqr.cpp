#include "algo/trajectory/ilqr.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/ilqr_backward.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kShares[] = {1.0F, 0.4F, 0.1F};  // of a correction, tried in this order
constexpr float kEnough = 0.05F;                 // of the promised decrease
constexpr float kSettledShare = 1e-3F;           // of the merit: a decrease that is not worth a pass,
constexpr float kSettled = 1e-6F;                // nor is one of this size, however small the merit
constexpr float kFutile = 1e-4F;                 // promised in vain: not worth damping (a kink of the model)
constexpr float kDampingGrowth = 10.0F;          // after a pass that found nothing
constexpr float kFirstDamping = 1.0F;
constexpr float kMostDamping = 1e3F;
constexpr float kFirstPenalty = 1.0F;
constexpr float kPenaltyGrowth = 5.0F;
constexpr int kPassesPerPenalty = 4;
constexpr float kTolerance = 0.05F;  // a bound broken by this share of its unit counts as kept

// How the start's path is followed to make an exact motion of it: a lateral error falls to 1/e over this way.
constexpr float kConvergenceM = 3.0F;
constexpr float kConvergenceS = 0.6F;

MotionInput within(const MotionInput& input, const MotionInput& most) {
  return {clamp(input.jerk_mps3, -most.jerk_mps3, most.jerk_mps3),
          clamp(input.curvature_rate_1pms, -most.curvature_rate_1pms, most.curvature_rate_1pms)};
}

}  // namespace

void Ilqr::follow(const RefinementProblem& problem, const Motion& start) {
  nominal_.states[0] = start.states[0];
  for (int i = 0; i < kHorizonSteps; ++i) {
    const RefinementStep& step = problem.steps[i];
    const MotionState& now = nominal_.states[i];
    const MotionState& wanted = start.states[i];
    const SinCos heading = sin_cos(wanted.heading_rad);
    const float across_m = (now.y_m - wanted.y_m) * heading.cos - (now.x_m - wanted.x_m) * heading.sin;
    const float per_m = 1.0F / max(kConvergenceM, kConvergenceS * now.speed_mps);
    const float correction_1pm = -per_m * (2.0F * (now.heading_rad - wanted.heading_rad) + per_m * across_m);
    const float curvature_1pm =
        start.states[i + 1].curvature_1pm + (wanted.speed_mps > 0.0F ? correction_1pm : 0.0F);
    const MotionInput input = {(start.states[i + 1].acceleration_mps2 - now.acceleration_mps2) / kStepS,
                               (curvature_1pm - now.curvature_1pm) / kStepS};
    nominal_.inputs[i] = within(input, step.input_bound);
    nominal_.states[i + 1] = motion_step(now, nominal_.inputs[i]);
  }
}

float Ilqr::merit_of_nominal(const RefinementProblem& problem) const {
  float merit = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    merit += step_merit(problem, bounds_, i, nominal_.inputs[i], nominal_.states[i + 1]);
  }
  return merit;
}

float Ilqr::try_share(const RefinementProblem& problem, float share, float limit) {
  float merit = 0.0F;
  trial_.states[0] = nominal_.states[0];
  for (int i = 0; i < kHorizonSteps && merit <= limit; ++i) {
    const InputCorrection& correction = corrections_[i];
    const InputVector input = vector_of(nominal_.inputs[i]) +
                              share * Eigen::Map<const InputVector>(correction.open) +
                              Eigen::Map<const InputByState>(correction.feedback) *
                                  (vector_of(trial_.states[i]) - vector_of(nominal_.states[i]));
    trial_.inputs[i] = within({input[kJerk], input[kRate]}, problem.steps[i].input_bound);
    trial_.states[i + 1] = motion_step(trial_.states[i], trial_.inputs[i]);
    merit += step_merit(problem, bounds_, i, trial_.inputs[i], trial_.states[i + 1]);  // each >= 0
  }
  return merit;
}

void Ilqr::keep_if_best(const RefinementProblem& problem, Motion& best, IlqrResult& result,
                        float& violation) const {
  const Judgement judgement = judge_motion(problem, nominal_);
  violation = judgement.violation;
  if (judgement.violation > kTolerance || judgement.cost() >= result.cost_after) return;
  best = nominal_;
  result.cost_after = judgement.cost();
  result.improved = true;
}

IlqrResult Ilqr::solve(const RefinementProblem& problem, int allowance, Motion& motion) {
  IlqrResult result;
  result.cost_before = judge_motion(problem, motion).cost();
  result.cost_after = result.cost_before;
  if (allowance <= 0) return result;

  follow(problem, motion);
  float violation = 0.0F;
  keep_if_best(problem, motion, result, violation);
  bounds_ = BoundState{};
  bounds_.penalty = kFirstPenalty;
  float merit = merit_of_nominal(problem);
  float damping = 0.0F;
  int since_penalty = 0;
  while (passes_spent(result.passes, result.failed_trials) < allowance) {
    ++result.passes;
    ++since_penalty;
    const float promised = backward_pass(problem, bounds_, nominal_, damping, corrections_);
    bool settled = promised <= max(kSettled, kSettledShare * (merit - problem.field_constant));
    if (!settled) {
      const float before = merit;
      for (const float share : kShares) {
        const float limit = before - kEnough * share * promised;
        const float trial = try_share(problem, share, limit);
        if (trial <= limit) {
          nominal_ = trial_;
          merit = trial;
          break;
        }
        ++result.failed_trials;
      }
      if (merit < before) {
        damping = 0.0F;
        keep_if_best(problem, motion, result, violation);
        settled = before - merit <= kSettledShare * (merit - problem.field_constant);
      } else {
        damping = max(kFirstDamping, kDampingGrowth * damping);
        settled = damping > kMostDamping || promised <= kFutile;
      }
    }
    if (settled && violation <= kTolerance) break;
    if (settled || (since_penalty >= kPassesPerPenalty && violation > kTolerance)) {
      update_multipliers(problem, nominal_, bounds_);
      bounds_.penalty *= kPenaltyGrowth;
      merit = merit_of_nominal(problem);
      damping = 0.0F;
      since_penalty = 0;
    }
  }
  return result;
}

}  // namespace s4tp::trajectory
