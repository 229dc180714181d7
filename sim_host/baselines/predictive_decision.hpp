#pragma once
/// Predictive-Decision (arXiv 2302.03939; method.md 5): the same candidates and the same predictor
/// as S4TP, asked about every candidate, and a weighted sum of seven features. No risk field. The network and its
/// weights are those of S4TP; predictive_decision_kinematic has the kinematic model in their place.
///
/// \code
///   feature    0 .. 1, so that the weights say what matters            weight
///   goal       way to the goal not gained, of the longest possible     1
///   speed      mean distance from the speed allowed, of it             0.5
///   jerk       mean |jerk|, of 10 m/s^3                                0.1
///   lateral    mean |lateral acceleration|, of what is feasible        0.1
///   distance   mean exp(-gap / 1 m) of the nearest vehicle             1
///   ttc        1 - (least time to collision) / 3 s                     5
///   collision  chance of one within the horizon                        10
/// \endcode
/// What a lane change still due counts, and one that is too late, says goal_distance.hpp; driving over the end of a road is a collision.
/// Modes of a vehicle count by their probability, the worst vehicle counts.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

struct PdCost {
  float goal = 0.0F;
  float speed = 0.0F;
  float jerk = 0.0F;
  float lateral = 0.0F;
  float distance = 0.0F;
  float ttc = 0.0F;
  float collision = 0.0F;
};

inline constexpr PdCost kPdWeights{1.0F, 0.5F, 0.1F, 0.1F, 1.0F, 5.0F, 10.0F};

[[nodiscard]] float weighted(const PdCost& features, const PdCost& weights);

/// \param line  reference line of ego path `path`, which the trajectory follows
/// \param predicted  conditioned on the trajectory; `others` covers vehicles beyond it
[[nodiscard]] PdCost pd_features(const scene::Scene& scene, int path, const trajectory::ReferenceLine& line,
                                 const Trajectory& trajectory, const satp::PredictionSet& predicted,
                                 const satp::KinematicSet& others, const Parameters& parameters);

/// Bare, the sum alone decides among feasible candidates; guarded, among those that pass S4TP's check, for a
/// guard behind it could only stop the one it prefers.
class PredictiveDecision {
 public:
  PredictiveDecision(bool guarded, bool learned) : guarded_(guarded), learned_(learned) {}
  [[nodiscard]] Status init(const Parameters& parameters);
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation);

  planner::Probe* probe = nullptr;

 private:
  bool guarded_;
  bool learned_;
  safety::Guard guard_;
  Parameters parameters_;
  scene::SceneBuilder scene_builder_;
  scene::Scene scene_;
  satp::Weights weights_;
  satp::PredictionTrust trust_;
  satp::EncoderScratch scratch_;
  satp::SatpPredictor predictor_;
  satp::PredictionSet marginal_;
  satp::KinematicSet constant_velocity_;
  trajectory::ReferenceLines lines_;
  trajectory::CandidateList candidates_;
};

template <bool kGuarded, bool kLearned>
class PredictiveDecisionPlanner : public PredictiveDecision {
 public:
  PredictiveDecisionPlanner() : PredictiveDecision(kGuarded, kLearned) {}
};

}  // namespace s4tp::baselines
