#include "algo/planner/planner.hpp"

#include <new>

#include "algo/behavior/manoeuvres.hpp"
#include "algo/core/inline.hpp"
#include "algo/core/self_test.hpp"
#include "algo/planner/input_check.hpp"
#include "algo/planner/stage_scope.hpp"
#include "algo/safety/fail_safe.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/driven_lines.hpp"

namespace s4tp::planner {
namespace {

constexpr std::uint8_t kNobody = 255;

/// What the network reads, and what is predicted of all vehicles.
std::int32_t encode_work(const scene::Scene& scene) {
  int paths = 0;
  for (int i = 0; i < scene.watched; ++i) paths += scene.agents[i].paths.size();
  return work::kEncode + work::kEncodeWatched * scene.watched + work::kEncodePath * paths +
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

  const bool running_valid = is_valid(running_, parameters_);
  // Whole: its fail-safe and its manoeuvre are believed no more than its points.
  if (!running_valid || running_.kind == PlanKind::kNone) running_ = Plan{};
  if (running_.kind != PlanKind::kNone)
    behavior::pass_time(static_cast<std::int32_t>(start_ms_ - running_.start_ms), running_.manoeuvre);
  const bool ego_valid = is_valid(input.ego);
  if (ego_valid) {
    last_ego_ = input.ego;
    last_ego_ms_ = input.now_ms;
    ego_seen_ = true;
  }

  Status status = Status::kInvalidInput;
  bool start_known = true;
  if (ego_valid && running_valid && are_others_valid(input)) {
    {
      const StageScope scope(probe, Stage::kScene);
      status = scene_builder_.build(input.now_ms, input.ego, input.tracks, input.tracks_ms, input.map,
                                    parameters_, scene_);
      believe(scene_);
      const int drivable_work = sadrf::build_drivable(input.map, drivable_);
      explanation.id_clashes = scene_.id_clashes;
      explanation.tracks_left_out = scene_.known.left_out;
      explanation.lanes_left_out = input.map != nullptr ? input.map->lanes_left_out : std::uint8_t{0};
      count(explanation, Stage::kScene, scene_.agents.size());
      work_.spend(Stage::kScene, scene_.work + drivable_work);
    }
    start_ = trajectory::plan_start(input.ego, input.now_ms, running_, start_ms_, parameters_);
    const float lead_s = 0.001F * static_cast<float>(start_ms_ - scene_.time_ms);
    if (status == Status::kOk) {
      const StageScope scope(probe, Stage::kCandidates);
      line_work_ = trajectory::build_lines(start_, lead_s, parameters_, scene_, lines_);
      work_.spend(Stage::kCandidates, line_work_);
    }
    reserved_ = {};
    reserved_.goes_on = static_cast<std::int8_t>(behavior::leads_to(running_.manoeuvre, scene_));
    if (status == Status::kOk) {
      const StageScope scope(probe, Stage::kCheck);
      const int look_work = guard_.look(scene_, start_, lead_s, parameters_);
      // What comes last is paid for first.
      work_.spend(Stage::kCheck, look_work + judge_work() + guard_.commit_work() + behavior::kAdvanceWork);
      work_.spend(Stage::kExplain, work::kExplain);
      if (scene_.list_refused) status = Status::kStaleTracks;
    }
    if (status == Status::kOk) {
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
  plan.manoeuvre = running_.manoeuvre;
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
  const FailSafe in_force = running_.fail_safe;
  const auto drive = [&](float branch_s, float braking_mps2) {
    running_.fail_safe.branch_s = branch_s;
    safety::drive_fail_safe(running_, start_, start_ms_, braking_mps2, parameters_, plan);
  };
  const float planned_mps2 = in_force.braking_mps2;
  drive(in_force.branch_s, planned_mps2 > 0.0F ? planned_mps2 : parameters_.guard.braking_mps2);
  if (status == Status::kNoSafePlan || status == Status::kStaleTracks) {
    // Where the one ahead has broken the law it takes more; before ground that somebody comes to who cannot stop, a stop at once.
    const safety::Verdict verdict = guard_.judge(0, plan.trajectory);
    const float hardest_mps2 = parameters_.vehicle.braking_max_mps2;
    if (verdict.cause == safety::Cause::kLeader) drive(in_force.branch_s, hardest_mps2);
    if (verdict.only_we_can_stop) drive(0.0F, hardest_mps2);
  }
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
  marginal_work_ = work::of_decode(marginal_.agents.size(), arena_.predictor.work());
  work_.spend(Stage::kPredict, encode_work(scene_) + decode_work());
  if (weights_.present()) trust_.remember(scene_, marginal_, start_ms_);
  arena_.predictor.constant_velocity(constant_velocity_);
  count(explanation, Stage::kPredict, arena_.predictor.work());
}

std::uint8_t PlanningCycle::track_id(int agent) const {
  return agent >= 0 && agent < scene_.agents.size() ? scene_.agents[agent].track.id : kNobody;
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
  const bool passes_group = verdict.clears && !verdict.stops_short;
  behavior::advance({candidates_[best].path, &chosen_, passes_group, verdict.cleared_end}, scene_,
                    parameters_, running_.manoeuvre);

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

const trajectory::RefinementProblem* PlanningCycle::last_refinement() const {
  return refining_ ? &arena_.optimizer.problem() : nullptr;
}

}  // namespace s4tp::planner
