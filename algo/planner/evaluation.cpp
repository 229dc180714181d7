// What a decision brings about: its prediction, its touches, its exact risk; and the refinement of the best.
#include <new>

#include "algo/core/inline.hpp"
#include "algo/planner/planner.hpp"
#include "algo/planner/stage_scope.hpp"
#include "algo/sadrf/overlap.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::planner {
namespace {

constexpr std::int32_t kLimitsWork = 150;  // to see whether a plan keeps to the limits of any plan
constexpr float kHardStopCost = 60.0F;     // of a plan that can only be given up by braking hard
constexpr float kCrashCost = 1000.0F;      // a certain crash outweighs all other terms of a score together

}  // namespace

float PlanningCycle::crash_cost(const satp::PredictionSet& prediction, Stage stage) {
  WorkMeter meter;
  const float expected = sadrf::expected_collisions(scene_, prediction, chosen_, parameters_, meter);
  work_.spend(stage, -meter.left);
  return kCrashCost * expected;
}

float PlanningCycle::hard_cost(int index) const {
  return (hard_ >> index & 1U) != 0 ? kHardStopCost : 0.0F;
}

bool PlanningCycle::hold(int index, Explanation& explanation) {
  roll_out(index);
  {
    const StageScope scope(probe, Stage::kCheck);
    work_.spend(Stage::kCheck, kLimitsWork);
    if (!trajectory::keeps_limits(chosen_, parameters_)) {  // the next cycle would not know it for ours
      explanation.rejections[index] = trajectory::Rejection::kInfeasible;
      return false;
    }
  }
  if (allowance.decisions <= 0) return true;  // it has passed with the predictions without plan
  {
    const StageScope scope(probe, Stage::kPredict);
    const int before = arena_.predictor.work();
    arena_.predictor.decode(&chosen_, allowance.prediction, conditioned_.set);
    count(explanation, Stage::kPredict, arena_.predictor.work() - before);
    const int steps = arena_.predictor.work() - before;
    work_.spend(Stage::kPredict, work::kDecode + work::of_decode(conditioned_.set.agents.size(), steps));
  }
  {
    const StageScope scope(probe, Stage::kCheck);
    count(explanation, Stage::kCheck, 1);
    work_.spend(Stage::kCheck, guard_.judge_work(candidates_[index].path));
    if (!verify(candidates_[index].path, chosen_).safe()) {
      explanation.rejections[index] = trajectory::Rejection::kRefused;
      return false;
    }
  }
  return true;
}

bool PlanningCycle::can_evaluate_risk(const Explanation& explanation) const {
  return explanation.work[static_cast<int>(Stage::kExactRisk)] < allowance.exact_risks &&
         work_.left() >= kLeastExactWork;
}

void PlanningCycle::evaluate_risk(const satp::PredictionSet& prediction, const Trajectory& trajectory,
                                  Explanation& explanation, sadrf::RiskProfile& profile) {
  // The others to come get as much.
  const int to_come = decisions_to_come_ > 1 ? decisions_to_come_ : 1;
  const std::int32_t left =
      work_.left() - (to_come - 1) * decision_work() - work::kTouches - trajectory::kSteeredWork;
  const std::int32_t share = left / to_come;
  WorkMeter meter{share < allowance.exact_risk ? share : allowance.exact_risk};
  const std::int32_t before = meter.left;
  sadrf::exact_risk(scene_, drivable_, prediction, constant_velocity_, trajectory, parameters_, profile,
                    meter);
  work_.spend(Stage::kExactRisk, before - meter.left);
  count(explanation, Stage::kExactRisk, 1);
}

bool PlanningCycle::evaluate(int index, Explanation& explanation) {
  explanation.risk = sadrf::RiskProfile{};
  if (!hold(index, explanation)) return false;
  // Without an allowance left the ranking's risk stands; without a prediction of its own, too.
  const StageScope scope(probe, Stage::kExactRisk);
  if (allowance.decisions <= 0 || !can_evaluate_risk(explanation)) return true;
  evaluate_risk(conditioned_.set, chosen_, explanation, explanation.risk);
  costs_[index].risk = parameters_.scoring.risk * sadrf::risk_integral(explanation.risk, parameters_) +
                       crash_cost(conditioned_.set, Stage::kExactRisk) + hard_cost(index);
  return true;
}

void PlanningCycle::refine(const trajectory::Candidate& candidate, Explanation& explanation) {
  std::int32_t left = work_.left() - work::kRefinement - kLimitsWork - judge_work();
  trajectory::RefinementAllowance allowed;
  // In the field the exact risk decides: what that takes at least is kept, and of the rest as much for passes as for the field.
  if (can_evaluate_risk(explanation) && parameters_.scoring.risk > 0.0F && left > kLeastExactWork) {
    allowed.evaluations = allowance.field_evaluations;
    allowed.field_work = (left - kLeastExactWork) / 2;
    if (allowed.field_work > allowance.field) allowed.field_work = allowance.field;
    left -= kLeastExactWork + allowed.field_work;
  }
  // The last one may take as much as two: trials that fail.
  const std::int32_t affordable_passes = left / kPassWork - 1;
  const int most =
      affordable_passes < allowance.optimizer_iterations ? affordable_passes : allowance.optimizer_iterations;
  allowed.passes = most > 0 ? to_int(parameters_.refinement.passes, 0, most) : 0;
  if (allowed.passes == 0) return;
  trajectory::RefinementResult result;
  {
    const StageScope scope(probe, Stage::kOptimize);
    new (&arena_.optimizer) trajectory::Optimizer;
    refining_ = true;
    result = arena_.optimizer.refine(lines_[candidate.path], candidate.start_s_m, surroundings(), parameters_,
                                     allowed, chosen_, refined_);
    count(explanation, Stage::kOptimize, result.passes);
    work_.spend(Stage::kOptimize,
                work::kRefinement + result.field_work +
                    kPassWork * trajectory::passes_spent(result.passes, result.failed_trials));
  }
  if (!result.improved) return;
  {
    const StageScope scope(probe, Stage::kCheck);
    count(explanation, Stage::kCheck, 1);
    work_.spend(Stage::kCheck, kLimitsWork + guard_.judge_work(candidate.path));
    // A refinement that does not pass is dropped: what it started from has passed.
    const bool passes_check =
        trajectory::keeps_limits(refined_, parameters_) && verify(candidate.path, refined_).safe();
    // A start is not postponed: the next cycle would begin at rest again, for ever.
    const bool postpones = refined_.points[1].speed_mps < 0.5F * chosen_.points[1].speed_mps;
    if (!passes_check || postpones) return;
  }
  if (result.evaluations > 0 && !is_better(result, explanation)) return;
  risk_outdated_ = result.evaluations == 0;
  chosen_ = refined_;
}

bool PlanningCycle::is_better(const trajectory::RefinementResult& result, Explanation& explanation) {
  const StageScope scope(probe, Stage::kExactRisk);
  sadrf::RiskProfile profile;
  evaluate_risk(conditioned_.set, refined_, explanation, profile);
  const float more =
      sadrf::risk_integral(profile, parameters_) - sadrf::risk_integral(explanation.risk, parameters_);
  if (result.own_after - result.own_before + parameters_.scoring.risk * more > 0.0F) return false;
  explanation.risk = profile;
  return true;
}

}  // namespace s4tp::planner
