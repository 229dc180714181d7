#pragma once
/// One planning cycle: scene -> predict -> risk -> optimize -> check (docs/architecture.md).
/// No heap, no globals, no recursion; every loop bounded; all state in this object.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/status.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/world_state.hpp"
#include "algo/planner/cycle_work.hpp"
#include "algo/planner/decision.hpp"
#include "algo/planner/explanation.hpp"
#include "algo/planner/probe.hpp"
#include "algo/sadrf/risk.hpp"
#include "algo/safety/guard.hpp"
#include "algo/satp/prediction_trust.hpp"
#include "algo/satp/satp_predictor.hpp"
#include "algo/scene/scene_builder.hpp"
#include "algo/trajectory/optimizer.hpp"

namespace s4tp::planner {

/// A snapshot of the world at a planning boundary. Pointers are valid during the call only.
struct PlannerInput {
  std::uint32_t now_ms = 0;    ///< vehicle time of `ego`
  std::uint32_t start_ms = 0;  ///< when the plan will take effect; now_ms <= start_ms <= now_ms + 200
  EgoState ego;
  TrackList tracks;
  std::uint32_t tracks_ms = 0;    ///< vehicle time of the track list
  const LaneMap* map = nullptr;   ///< null: no whole map known
  const Plan* running = nullptr;  ///< the plan in force, or null; CORE-014 one that keeps_limits() (CAND-020)
                                  ///< does not know for ours makes the input invalid and counts as none
  std::uint8_t degraded = 0;      ///< 0: all sources well; else drive carefully (lower speed, no lane change)
};

/// What each stage may spend, in its own work units: the same cut on every target. CORE-009 Whatever is left
/// of it, down to none, the plan is one that can be driven and has passed the check, or the minimum-risk
/// manoeuvre.
struct WorkAllowance {
  int candidates =
      kMaxCandidates;  ///< candidates tried; of none there is no plan but the minimum-risk manoeuvre
  /// Agent-mode-steps of one prediction; whom it leaves out keeps its velocity.
  int prediction = satp::kMaxPredictionWork;
  /// CORE-076 Of the whole cycle, WorkMeter's units: what stages that are not cut have taken, fewer decisions, less
  /// exact risks and fewer passes of the optimizer make up for.
  std::int32_t cycle = kCycleWork;
  std::int32_t ranking = kRankWork;      ///< of it for the ranking's risks; whom they leave out is not chosen
  std::int32_t exact_risk = kExactWork;  ///< of it for each exact risk
  int decisions = kMaxDecisions;         ///< conditioned predictions; without one the best ranked is chosen
  /// CORE-073 Exact risks, first of all one for each decision; beyond, the ranking's risk stands, and what is
  /// told is that of the plan before its last changes.
  int exact_risks = kMaxExactRisk;
  int optimizer_iterations = 16;  ///< passes of the optimizer
  /// Times the optimizer evaluates the risk field, at most 3; 0: it smooths only. To judge what comes of it takes an
  /// exact risk more.
  int field_evaluations = 3;
  std::int32_t field = kFieldWork;  ///< of the cycle for all of them
};

/// The cycle. What it is composed with, the guard and the belief that others move as they are seen to, a
/// planner to compare with replaces (sim_host/baselines); the one for cars is Planner.
class PlanningCycle {
 public:
  /// Checks the arithmetic and the parameters; forgets all history. \return kOk, kArithmetic,
  /// kInvalidParameter
  [[nodiscard]] Status init(const Parameters& parameters);

  /// SATP-055 From the next cycle on the network predicts, if the image is sound; if not, the kinematic
  /// predictor does. Without this call the first init() takes the weights the build carries; later ones leave
  /// them as they are. \param image  stays where it is while the planner lives; null: no network
  /// \return why it was refused \note reads the whole image: at start or in standby only
  [[nodiscard]] satp::WeightStatus use_weights(const void* image, std::uint32_t size_bytes);
  /// Of the last image looked at; kAbsent: none was given.
  [[nodiscard]] satp::WeightStatus weight_status() const { return weight_status_; }

  /// Plans from the state predicted for input.start_ms. Writes a plan that can be driven: on kNoLane
  /// and kNoSafePlan the minimum-risk manoeuvre; on kStaleTracks too, whatever the scene still knows of the
  /// others. \return kOk, kNoLane, kNoSafePlan, kStaleTracks, kInvalidInput (plan = minimum-risk,
  /// of kind none where no valid state of ours was ever seen), kNotInitialized (plan untouched)
  [[nodiscard]] Status plan(const PlannerInput& input, Plan& plan, Explanation& explanation);

  /// What the optimizer was asked in the last cycle, for benchmarks; null when it was not asked.
  [[nodiscard]] const trajectory::RefinementProblem* last_refinement() const;
  /// And what the risk was there.
  [[nodiscard]] trajectory::Surroundings surroundings() const {
    return {scene_, marginal_, conditioned_.set, constant_velocity_};
  }

  /// What the last cycle was charged.
  [[nodiscard]] const CycleWork& work() const { return work_; }

  WorkAllowance allowance;
  Probe* probe = nullptr;  ///< optional; not owned

 protected:
  PlanningCycle() = default;
  PlanningCycle(const PlanningCycle&) = default;
  PlanningCycle& operator=(const PlanningCycle&) = default;
  ~PlanningCycle() = default;

  /// What is made of the scene before anything is planned in it.
  virtual void believe(scene::Scene&) const {}
  /// Whether a feasible plan may be driven. \param path  index of the ego path it follows
  [[nodiscard]] virtual safety::Verdict verify(int path, const Trajectory& trajectory) const {
    return guard_.judge(path, trajectory);
  }

 private:
  void forget_scene();
  /// Sets start_ from what is still to be believed when the input as a whole is not. \return false: nothing
  /// is
  [[nodiscard]] bool start_without_input(bool ego_valid);
  void predict(Explanation& explanation);
  class Ranking;
  /// Generates the candidates, scores each against the predictions without plan and shortlists the decisions.
  void rank(bool careful, Explanation& explanation);
  /// Evaluates the shortlisted decisions with the predictions they bring about; leaves the best in chosen_.
  [[nodiscard]] Status choose(Explanation& explanation);
  [[nodiscard]] float hard_cost(int index) const;
  void roll_out(int index);  ///< of the candidates, into chosen_
  /// The same, predicts for it and checks it.
  [[nodiscard]] bool hold(int index, Explanation& explanation);
  /// The same, and computes its exact risk.
  [[nodiscard]] bool evaluate(int index, Explanation& explanation);
  [[nodiscard]] int shortlisted() const;  ///< decisions that get a prediction of their own
  /// So many of them that there is work left for each one's prediction and exact risk.
  [[nodiscard]] int affordable() const;
  [[nodiscard]] std::int32_t decode_work() const;    ///< of one of them
  [[nodiscard]] std::int32_t decision_work() const;  ///< and of all else it takes, but for its exact risk
  [[nodiscard]] std::int32_t judge_work() const;     ///< of a plan on any path
  [[nodiscard]] std::uint8_t track_id(int agent) const;
  void explain_risk(Status status, Explanation& explanation);
  [[nodiscard]] bool can_evaluate_risk(const Explanation& explanation) const;
  void evaluate_risk(const satp::PredictionSet& prediction, const Trajectory& trajectory,
                     Explanation& explanation, sadrf::RiskProfile& profile);
  /// Price of the touches that are to be expected.
  [[nodiscard]] float crash_cost(const satp::PredictionSet& prediction, Stage stage);
  /// Drives the fail-safe of the plan in force.
  void give_up(Status status, Plan& plan);
  void refine(const trajectory::Candidate& candidate, Explanation& explanation);
  /// Whether refined_ costs no more than chosen_, by the exact risk; then explanation.risk is of it.
  [[nodiscard]] bool is_better(const trajectory::RefinementResult& result, Explanation& explanation);

  bool initialized_ = false;
  Parameters parameters_;
  std::uint32_t parameters_crc_ = 0;
  scene::SceneBuilder scene_builder_;
  EgoState last_ego_;  ///< the last valid one, of ...
  std::uint32_t last_ego_ms_ = 0;
  bool ego_seen_ = false;  ///< ... if any

  // One cycle's data, in the order it flows.
  CycleWork work_;
  std::int32_t marginal_work_ = 0;  ///< of the prediction without plan
  std::uint32_t start_ms_ = 0;
  Plan running_;  ///< its manoeuvre is moved on as soon as another plan is taken
  scene::Scene scene_;
  sadrf::DrivableArea drivable_;
  safety::Guard guard_;
  TrajectoryPoint start_;
  satp::YieldBeliefs beliefs_;
  satp::Weights weights_;
  satp::WeightStatus weight_status_ = satp::WeightStatus::kAbsent;
  bool given_weights_ = false;  ///< or looked for in the build
  satp::PredictionTrust trust_;
  satp::PredictionSet marginal_;
  satp::KinematicSet constant_velocity_;
  trajectory::ReferenceLines lines_;
  std::int32_t line_work_ = 0;  ///< that they took
  trajectory::CandidateList candidates_;
  trajectory::Leader leaders_[decltype(scene::Scene::ego_paths)::kCapacity];  ///< along each path
  CostBreakdown costs_[kMaxCandidates];
  std::uint32_t hard_ = 0;  ///< bit i: candidate i can only be given up by braking hard
  DecisionList decisions_;
  Reserved reserved_;          ///< on the shortlist
  int decisions_to_come_ = 0;  ///< exact risks, with this one
  /// Before anything is predicted for a plan, its room serves the network.
  union Conditioned {
    Conditioned() : set() {}
    satp::PredictionSet set;
    satp::EncoderScratch scratch;
  };
  Conditioned conditioned_;
  Trajectory chosen_;
  Trajectory refined_;
  FailSafe fail_safe_;
  sadrf::RiskProfile best_risk_;  ///< of the best decision so far
  bool risk_outdated_ = false;    ///< chosen_ is refined_, explanation.risk not of it

  /// Scratch of stages that never need it at once: the path hypotheses have served when the optimizer
  /// begins.
  union Arena {
    Arena() : predictor() {}
    satp::SatpPredictor predictor;
    trajectory::Optimizer optimizer;
  };
  Arena arena_;
  bool refining_ = false;  ///< the arena holds the optimizer
};

/// The planner of the firmware.
class Planner final : public PlanningCycle {};

static_assert(sizeof(Planner) <= kPlannerBudgetBytes, "the planner object has outgrown its budget");

}  // namespace s4tp::planner
