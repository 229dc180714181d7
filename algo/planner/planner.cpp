#include "algo/planner/planner.hpp"

#include <new>

#include "algo/core/inline.hpp"
#include "algo/core/self_test.hpp"
#include "algo/planner/stage_scope.hpp"
#include "algo/sadrf/overlap.hpp"
#include "algo/safety/fail_safe.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/lateral_offset.hpp"
#include "algo/trajectory/plan_limits.hpp"

namespace s4tp::planner {
namespace {

constexpr std::uint32_t kMaxLeadMs = 200;  // plan start after the snapshot
constexpr std::uint8_t kNobody = 255;
constexpr float kFarthestM = 1e5F;         // from the frame's origin
constexpr std::int32_t kLimitsWork = 150;  // to see whether a plan keeps to the limits of any plan
constexpr float kCrashCost = 1000.0F;      // a certain crash outweighs all other terms of a score together

bool within(float x, float low, float high) {
  return is_finite(x) && x >= low && x <= high;
}

bool valid(const Pose& pose) {
  return abs(pose.x_m) < kFarthestM && abs(pose.y_m) < kFarthestM && within(pose.heading_rad, -kPi, kPi);
}

bool valid(const EgoState& ego) {
  return valid(ego.rear_axle) && within(ego.speed_mps, 0.0F, 60.0F) &&
         within(ego.acceleration_mps2, -12.0F, 12.0F) && within(ego.yaw_rate_radps, -2.1F, 2.1F) &&
         within(ego.steering_rad, -0.8F, 0.8F);
}

bool valid(const Track& track) {
  return valid(track.centre) && within(track.speed_mps, 0.0F, 61.0F) &&
         within(track.acceleration_mps2, -13.0F, 13.0F) && within(track.yaw_rate_radps, -1.3F, 1.3F) &&
         within(track.length_m, 0.5F, 26.0F) && within(track.width_m, 0.3F, 3.2F);
}

bool valid(const Plan& plan, const Parameters& parameters) {
  if (plan.kind == PlanKind::kNone) return true;
  return plan.kind <= PlanKind::kMinimumRisk && trajectory::keeps_limits(plan.trajectory, parameters) &&
         within(plan.fail_safe.branch_s, 0.0F, 3.0F) && within(plan.fail_safe.braking_mps2, 0.0F, 13.0F);
}

bool others_valid(const PlannerInput& input) {
  if (input.start_ms - input.now_ms > kMaxLeadMs) return false;
  for (const Track& track : input.tracks) {
    if (!valid(track)) return false;
  }
  return true;
}

/// What a decode takes beyond work::kDecode. \param steps  of agents' modes, the network's among them
std::int32_t work_of(const satp::PredictionSet& prediction, int steps) {
  return work::kDecodeAgent * prediction.agents.size() + work::kDecodeStep * steps;
}

/// What the network reads, and what is predicted of all vehicles.
std::int32_t encode_work(const scene::Scene& scene) {
  int ways = 0;
  for (int i = 0; i < scene.watched; ++i) ways += scene.agents[i].paths.size();
  return work::kEncode + work::kEncodeWatched * scene.watched + work::kEncodePath * ways +
         work::kGoesOn * scene.agents.size();
}

}  // namespace

Status PlanningCycle::init(const Parameters& parameters) {
  initialized_ = false;
  int first_bad = 0;
  Status status = arithmetic_self_test();
  if (status == Status::kOk) status = validate(parameters, first_bad);
  if (status != Status::kOk) return status;
  parameters_ = parameters;
  parameters_crc_ = s4tp::parameters_crc(parameters);
  scene_builder_.reset();
  beliefs_.reset();
  trust_.reset();
  if (!given_weights_) {
    const satp::ShippedWeights shipped = satp::shipped_weights();
    weight_status_ = satp::Weights::check(shipped.image, shipped.size_bytes, weights_);
    given_weights_ = true;
  }
  guard_.reset();
  ego_seen_ = false;
  initialized_ = true;
  return Status::kOk;
}

satp::WeightStatus PlanningCycle::use_weights(const void* image, std::uint32_t size_bytes) {
  weights_ = satp::Weights{};
  trust_.reset();
  given_weights_ = true;
  weight_status_ = satp::Weights::check(image, size_bytes, weights_);
  return weight_status_;
}

Status PlanningCycle::plan(const PlannerInput& input, Plan& plan, Explanation& explanation) {
  if (!initialized_) return Status::kNotInitialized;
  explanation = Explanation{};
  explanation.parameters_crc = parameters_crc_;
  running_ = input.running != nullptr ? *input.running : Plan{};
  start_ms_ = input.start_ms;

  conditioned_.set.agents.clear();
  risk_outdated_ = false;
  refining_ = false;
  work_.begin(allowance.cycle);

  const bool running_valid = valid(running_, parameters_);
  if (!running_valid) running_ = Plan{};  // whole: its fail-safe is believed no more than its points
  const bool ego_valid = valid(input.ego);
  if (ego_valid) {
    last_ego_ = input.ego;
    last_ego_ms_ = input.now_ms;
    ego_seen_ = true;
  }

  Status status = Status::kInvalidInput;
  bool start_known = true;
  if (ego_valid && running_valid && others_valid(input)) {
    {
      const StageScope scope(probe, Stage::kScene);
      status = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms, input.map,
                                    parameters_, scene_);
      believe(scene_);
      const int drivable_work = sadrf::build_drivable(input.map, drivable_);
      const int aside_work = trajectory::set_lateral_offsets(parameters_, scene_);
      explanation.id_clashes = scene_.id_clashes;
      explanation.tracks_left_out = scene_.known.left_out;
      explanation.lanes_left_out = input.map != nullptr ? input.map->lanes_left_out : std::uint8_t{0};
      count(explanation, Stage::kScene, scene_.agents.size());
      work_.spend(Stage::kScene, scene_.work + drivable_work + aside_work);
    }
    start_ = trajectory::plan_start(input.ego, input.now_ms, running_, start_ms_, parameters_);
    if (status == Status::kOk && scene_.list_refused) status = Status::kStaleTracks;
    if (status == Status::kOk) {
      {
        const StageScope scope(probe, Stage::kCheck);
        const int look_work =
            guard_.look(scene_, start_, 0.001F * static_cast<float>(start_ms_ - scene_.time_ms), parameters_);
        // What comes last is paid for first.
        work_.spend(Stage::kCheck, look_work + judge_work() + guard_.commit_work());
        work_.spend(Stage::kExplain, work::kExplain);
      }
      predict(explanation);
      rank(input.degraded != 0, explanation);
      status = choose(explanation);
      if (probe != nullptr) probe->candidates_done({start_, running_, lines_, candidates_, costs_});
    }
  } else {
    forget_scene();  // nothing of a broken input may be used
    start_known = start_without_input(ego_valid);
  }
  plan.kind = status == Status::kOk ? PlanKind::kDrive : PlanKind::kNone;
  plan.start_ms = start_ms_;
  plan.fail_safe = status == Status::kOk ? fail_safe_ : FailSafe{};
  if (!start_known) {
    for (TrajectoryPoint& point : chosen_.points) point = TrajectoryPoint{};
  } else if (status != Status::kOk) {
    give_up(status, plan);
  }

  if (status == Status::kOk || status == Status::kNoSafePlan) explain_risk(status, explanation);

  plan.trajectory = chosen_;
  explanation.status = status;
  if (probe != nullptr) probe->cycle_done(scene_, conditioned_.set, explanation.risk);
  return status;
}

void PlanningCycle::give_up(Status status, Plan& plan) {
  using safety::drive_fail_safe;
  const float planned_mps2 = running_.fail_safe.braking_mps2;
  const float braking_mps2 = planned_mps2 > 0.0F ? planned_mps2 : parameters_.guard.braking_mps2;
  drive_fail_safe(running_, start_, start_ms_, braking_mps2, parameters_, plan);
  // Where the one ahead has broken the law it takes more.
  const bool too_near =
      status == Status::kNoSafePlan && guard_.judge(0, plan.trajectory).cause == safety::Cause::kLeader;
  if (too_near)
    drive_fail_safe(running_, start_, start_ms_, parameters_.vehicle.braking_max_mps2, parameters_, plan);
  chosen_ = plan.trajectory;
}

void PlanningCycle::explain_risk(Status status, Explanation& explanation) {
  const StageScope scope(probe, Stage::kExactRisk);
  // What the optimizer changed, or the minimum-risk manoeuvre, has its risk anew while the allowance lasts.
  const bool changed = status != Status::kOk || risk_outdated_;
  const satp::PredictionSet& prediction = status == Status::kOk ? conditioned_.set : marginal_;
  if (changed && can_evaluate_risk(explanation)) {
    evaluate_risk(prediction, chosen_, explanation, explanation.risk);
  } else if (status != Status::kOk) {
    explanation.risk = sadrf::RiskProfile{};  // it is of a motion that was rejected
  }
  explanation.dominating_track = track_id(explanation.risk.dominating_agent);
  explanation.dominating_step =
      explanation.dominating_track == kNobody ? std::uint8_t{0} : explanation.risk.dominating_step;
  explanation.rests_on = expected_future(prediction, explanation.risk.dominating_agent);
  explanation.rests_on.trust = trust_.of(explanation.dominating_track);
}

void PlanningCycle::forget_scene() {
  scene_.ego_paths.clear();
  scene_.agents.clear();
  scene_.watched = 0;
  scene_.map = nullptr;
}

bool PlanningCycle::start_without_input(bool ego_valid) {
  if (!ego_valid && trajectory::plan_covers(running_, start_ms_)) {
    start_ = sample(running_, start_ms_);
    return true;
  }
  if (!ego_seen_) return false;
  start_ = trajectory::plan_start(last_ego_, last_ego_ms_, running_, start_ms_, parameters_);
  return true;
}

void PlanningCycle::predict(Explanation& explanation) {
  const StageScope scope(probe, Stage::kPredict);
  new (&arena_.predictor) satp::SatpPredictor;
  explanation.learned = weights_.present();
  if (weights_.present()) trust_.observe(scene_, weights_.header().usual_residual_m);
  arena_.predictor.encode(weights_, scene_, parameters_, start_ms_, &beliefs_, &trust_, conditioned_.scratch);
  new (&conditioned_.set) satp::PredictionSet;
  satp::YieldHypotheses hypotheses[kMaxAgents];
  arena_.predictor.hypotheses(hypotheses);
  beliefs_.observe(scene_, hypotheses);
  arena_.predictor.decode(nullptr, allowance.prediction, marginal_);
  marginal_work_ = work_of(marginal_, arena_.predictor.work());
  work_.spend(Stage::kPredict, encode_work(scene_) + decode_work());
  if (weights_.present()) trust_.remember(scene_, marginal_, start_ms_);
  arena_.predictor.constant_velocity(constant_velocity_);
  count(explanation, Stage::kPredict, arena_.predictor.work());
}

std::uint8_t PlanningCycle::track_id(int agent) const {
  return agent >= 0 && agent < scene_.agents.size() ? scene_.agents[agent].track.id : kNobody;
}

float PlanningCycle::crash_cost(const satp::PredictionSet& prediction, Stage stage) {
  WorkMeter meter;
  const float expected = sadrf::expected_collisions(scene_, prediction, chosen_, parameters_, meter);
  work_.spend(stage, -meter.left);
  return kCrashCost * expected;
}

Status PlanningCycle::choose(Explanation& explanation) {
  int best = -1;
  int second = -1;
  bool holds_best = false;  // its trajectory and prediction are in chosen_ and conditioned_
  for (int i = decisions_.size() - 1; i >= 0; --i) {  // the likely winner last: it is then held already
    const int index = decisions_[i].candidate;
    decisions_to_come_ = i + 1;
    if (holds_best) arena_.predictor.put_aside(conditioned_.set);
    holds_best = false;
    if (!evaluate(index, explanation)) continue;
    ++explanation.decisions;
    if (best < 0 || costs_[index].total() <= costs_[best].total()) {
      second = best;
      best = index;
      best_risk_ = explanation.risk;
      holds_best = true;
    } else if (second < 0 || costs_[index].total() <= costs_[second].total()) {
      second = index;
    }
  }
  if (best < 0) return Status::kNoSafePlan;
  decisions_to_come_ = 0;
  if (!holds_best) {
    roll_out(best);
    conditioned_.set = arena_.predictor.aside();
  }
  explanation.risk = best_risk_;
  refine(candidates_[best], explanation);
  const safety::Verdict verdict = guard_.judge(candidates_[best].path, chosen_);
  guard_.commit(candidates_[best].path, verdict);
  fail_safe_ = verdict.fail_safe;

  const StageScope scope(probe, Stage::kExplain);
  explanation.chosen = candidates_[best];
  explanation.chosen_cost = costs_[best];
  if (second >= 0) {
    explanation.runner_up = candidates_[second];
    explanation.runner_up_cost = costs_[second];
    explanation.runner_up_manoeuvre = scene_.ego_paths[candidates_[second].path].manoeuvre;
  }
  const scene::EgoPath& path = scene_.ego_paths[candidates_[best].path];
  explanation.manoeuvre = path.manoeuvre;
  const trajectory::Leader& leader = leaders_[candidates_[best].path];
  explanation.leader_track = track_id(leader.agent);
  explanation.leader_gap_m = leader.gap_m;
  return Status::kOk;
}

void PlanningCycle::roll_out(int index) {
  const StageScope scope(probe, Stage::kCandidates);
  const trajectory::Candidate& candidate = candidates_[index];
  work_.spend(Stage::kCandidates, candidate.steered ? trajectory::kSteeredWork : trajectory::kRollOutWork);
  trajectory::roll_out(lines_[candidate.path], candidate, start_, running_, start_ms_, parameters_, chosen_);
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
    work_.spend(Stage::kPredict, work::kDecode + work_of(conditioned_.set, arena_.predictor.work() - before));
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
                       crash_cost(conditioned_.set, Stage::kExactRisk) + hard_[index];
  return true;
}

const trajectory::RefinementProblem* PlanningCycle::last_refinement() const {
  return refining_ ? &arena_.optimizer.problem() : nullptr;
}

void PlanningCycle::refine(const trajectory::Candidate& candidate, Explanation& explanation) {
  // The last one may take as much as two: trials that fail.
  const std::int32_t affordable_passes = (work_.left() - work::kRefinement - judge_work()) / kPassWork - 1;
  const int most =
      affordable_passes < allowance.optimizer_iterations ? affordable_passes : allowance.optimizer_iterations;
  const int passes = most > 0 ? to_int(parameters_.refinement.passes, 0, most) : 0;
  // In the field the exact risk decides.
  const bool can_decide = can_evaluate_risk(explanation);
  const int evaluations = can_decide && parameters_.scoring.risk > 0.0F ? allowance.field_evaluations : 0;
  if (passes == 0) return;
  trajectory::RefinementResult result;
  {
    const StageScope scope(probe, Stage::kOptimize);
    new (&arena_.optimizer) trajectory::Optimizer;
    refining_ = true;
    result = arena_.optimizer.refine(lines_[candidate.path], candidate.start_s_m, surroundings(), parameters_,
                                     {passes, evaluations}, chosen_, refined_);
    count(explanation, Stage::kOptimize, result.passes);
    work_.spend(Stage::kOptimize, work::kRefinement + kPassWork * trajectory::passes_spent(
                                                                      result.passes, result.failed_trials));
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
