#include "algo/core/inline.hpp"
#include "algo/planner/lane_cost_to_go.hpp"
#include "algo/planner/planner.hpp"
#include "algo/planner/scoring.hpp"
#include "algo/planner/stage_scope.hpp"

namespace s4tp::planner {
/// Looks at each candidate while its roll-out is in chosen_.
class PlanningCycle::Ranking final : public trajectory::CandidateVisitor {
 public:
  Ranking(PlanningCycle& planner, bool careful, Explanation& explanation)
      : trajectory::CandidateVisitor(planner.chosen_),
        planner_(planner),
        careful_(careful),
        explanation_(explanation),
        risk_work_{planner.allowance.ranking},
        kept_(planner.decision_work() + kLeastExactWork + kCandidatesWork +
              sadrf::least_rank_work(planner.scene_)) {
    const std::int32_t lead_ms = static_cast<std::int32_t>(planner.start_ms_ - planner.scene_.time_ms);
    const std::int32_t left = planner.work_.left() - (kept_ - kCandidatesWork);
    // However long lines took: without a candidate we stand where we are for ever.
    const std::int32_t row = kCandidatesWork - planner.line_work_;
    const std::int32_t most = row > kCandidatesWork / 2 ? row : kCandidatesWork / 2;
    given_ = meter.left = left < most ? left : most;
    const int look_work = cost_to_go_.look(planner.scene_, planner.constant_velocity_,
                                           0.001F * static_cast<float>(lead_ms), planner.parameters_);
    meter.spend(work::kCandidates + look_work + cost_to_go_.asking_work());
  }

  /// The gap beside worth a candidate of its own.
  [[nodiscard]] trajectory::MergeTarget aim() const {
    return merge_target_of(planner_.scene_, cost_to_go_, planner_.parameters_);
  }

  /// On the candidates themselves.
  [[nodiscard]] std::int32_t spent() const { return given_ - meter.left; }

  void visit(int index) override {
    const InnerStageScope scope(planner_.probe, Stage::kCandidates, Stage::kRank);
    const trajectory::Candidate& candidate = planner_.candidates_[index];
    const bool previous = candidate.intent == trajectory::Intent::kPrevious;
    const bool leaves_lane = planner_.scene_.ego_paths[candidate.path].manoeuvre != scene::Manoeuvre::kKeep;
    trajectory::Rejection& rejection = explanation_.rejections[index];
    if (free() < work::kMostScore || (careful_ && leaves_lane && !goes_on(candidate))) {
      rejection = trajectory::Rejection::kLeftOut;
      return;
    }
    planner_.work_.spend(Stage::kRank, planner_.guard_.judge_work(candidate.path));
    const safety::Verdict verdict = planner_.verify(candidate.path, rolled_out);
    rejection = verdict.safe() ? trajectory::Rejection::kNone : trajectory::Rejection::kRefused;
    if (verdict.hard) planner_.hard_ |= std::uint32_t{1} << index;
    if (rejection == trajectory::Rejection::kNone) {
      score(index, candidate, previous);
    } else {
      note_blocking(candidate.path, verdict);
    }
  }

 private:
  /// Whether it does not leave the manoeuvre in force.
  [[nodiscard]] bool goes_on(const trajectory::Candidate& candidate) const {
    return candidate.path == planner_.reserved_.goes_on;
  }

  /// What may be spent on the candidate at hand.
  [[nodiscard]] std::int32_t free() const { return planner_.work_.left() - kept_; }

  void score(int index, const trajectory::Candidate& candidate, bool previous) {
    const scene::Scene& scene = planner_.scene_;
    const Parameters& parameters = planner_.parameters_;
    DecisionList& decisions = planner_.decisions_;
    CostBreakdown& cost = planner_.costs_[index];
    int took = work::kVisit;
    cost = score_motion(scene, cost_to_go_, candidate.path, planner_.lines_[candidate.path],
                        planner_.guard_.start_s_m(candidate.path), rolled_out, !goes_on(candidate), careful_,
                        parameters, took);
    planner_.work_.spend(Stage::kRank, took);
    count(explanation_, Stage::kRank, 1);
    const DecisionKey key = decision_key(scene, candidate.path, rolled_out, planner_.marginal_);
    if (previous) {
      planner_.reserved_.keeps_plan = true;
      planner_.reserved_.plan = key;
    }
    // Risk only adds to the score: who is beaten without it needs none computed. What is reserved stays anyway.
    const Reserved& reserved = planner_.reserved_;
    const auto is_open = [&]() {
      const bool stays =
          (reserved.keeps_plan && key == reserved.plan) ||
          (reserved.holds(candidate.path) && decisions.leads_path(candidate.path, cost.total()));
      return decisions.open_to(key, cost.total(), stays ? kMaxCandidates : planner_.shortlisted());
    };
    if (!is_open()) return;
    cost.risk = planner_.crash_cost(planner_.marginal_, Stage::kRank) + planner_.hard_cost(index);
    if (!is_open()) return;
    if (risk_work_.left > free()) risk_work_.left = free();
    if (risk_work_.left <= 0) {
      explanation_.rejections[index] = trajectory::Rejection::kLeftOut;
      return;
    }
    const std::int32_t before = risk_work_.left;
    cost.risk += parameters.scoring.risk * sadrf::rank_risk_of_vehicles(scene, planner_.marginal_,
                                                                        planner_.constant_velocity_,
                                                                        rolled_out, parameters, risk_work_);
    if (is_open()) {
      cost.risk += parameters.scoring.risk *
                   sadrf::rank_risk_of_road(planner_.drivable_, rolled_out, parameters, risk_work_);
      decisions.offer(key, index, cost.total());
    }
    planner_.work_.spend(Stage::kRank, before - risk_work_.left);
  }

  void note_blocking(int path, const safety::Verdict& verdict) {
    const scene::Manoeuvre manoeuvre = planner_.scene_.ego_paths[path].manoeuvre;
    BlockingReason& blocking =
        manoeuvre == scene::Manoeuvre::kKeep ? explanation_.blocking : explanation_.beside;
    float way_m = 0.0F;
    for (const TrajectoryPoint& point : rolled_out.points) way_m = way_m + kStepS * point.speed_mps;
    if (!blocking.verdict.safe() && way_m <= blocking.way_m) return;
    blocking = {verdict, planner_.track_id(verdict.agent), manoeuvre, way_m};
  }

  PlanningCycle& planner_;
  const bool careful_;
  Explanation& explanation_;
  WorkMeter risk_work_;
  std::int32_t kept_;       ///< for one decision, and for what the candidates still take
  std::int32_t given_ = 0;  ///< to the candidates themselves
  LaneCostToGo cost_to_go_;
};

int PlanningCycle::shortlisted() const {
  return allowance.decisions > 1 ? allowance.decisions : 1;
}

std::int32_t PlanningCycle::decode_work() const {
  // At most what the one without plan took.
  return work::kDecode + marginal_work_;
}

std::int32_t PlanningCycle::judge_work() const {
  std::int32_t most = 0;
  for (int path = 0; path < scene_.ego_paths.size(); ++path) {
    const std::int32_t one = guard_.judge_work(path);
    if (one > most) most = one;
  }
  return most;
}

std::int32_t PlanningCycle::decision_work() const {
  return decode_work() + work::kTouches + trajectory::kSteeredWork + judge_work();
}

int PlanningCycle::affordable() const {
  int count = shortlisted();
  const std::int32_t one = decision_work() + kLeastExactWork;
  while (count > 1 && work_.left() < count * one + trajectory::kSteeredWork) --count;
  return count;
}

void PlanningCycle::rank(bool careful, Explanation& explanation) {
  decisions_.clear();
  hard_ = 0;
  {
    const StageScope scope(probe, Stage::kCandidates);
    int left_out = 0;
    Ranking ranking(*this, careful, explanation);
    trajectory::generate_candidates(scene_, start_, running_, start_ms_, parameters_, allowance.candidates,
                                    lines_, candidates_, left_out, ranking, ranking.aim());
    explanation.left_out = static_cast<std::uint8_t>(to_int(static_cast<float>(left_out), 0, 255));
    explanation.candidate_count = static_cast<std::uint8_t>(candidates_.size());
    count(explanation, Stage::kCandidates, candidates_.size());
    work_.spend(Stage::kCandidates, ranking.spent());
    for (int path = 0; path < scene_.ego_paths.size(); ++path) leaders_[path] = ranking.leaders[path];
  }
  const StageScope scope(probe, Stage::kRank);
  work_.spend(Stage::kRank, work::kVisit);
  decisions_.shortlist(affordable(), reserved_);
}

}  // namespace s4tp::planner
