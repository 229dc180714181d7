#pragma once
/// Prediction of other drivers (method.md 2): encode the scene once, then decode without our plan or for
/// a plan. The method behind it now is kinematic: each vehicle follows its lane paths by car-following (IDM)
/// and yields at conflict zones; conditioning makes our planned motion one more vehicle it reacts to.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/ego_motion.hpp"
#include "algo/satp/path_hypothesis.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/satp/yield_belief.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::satp {

/// Most work of one vehicle: every path of it, undisturbed and yielding.
inline constexpr int kMaxAgentWork = 2 * kPathsPerAgent * kHorizonSteps;

/// Work of the network on one vehicle: GRU steps of its modes.
inline constexpr int kNetworkAgentWork = 18;

/// Most work of one decode: both predictors on every vehicle.
inline constexpr int kMaxPredictionWork = kMaxAgents * (kMaxAgentWork + kNetworkAgentWork);

class Predictor {
 public:
  /// Reads the scene once; `scene` must outlive the following calls of this cycle.
  /// \param start_ms  plan start: the predictions' time zero; scene.time_ms <= start_ms
  void encode(const scene::Scene& scene, const Parameters& parameters, std::uint32_t start_ms,
              const YieldBeliefs* beliefs = nullptr);

  /// What each watched vehicle would do now if it went first, and if it let us go first: on its likeliest path
  /// that crosses ours.
  void hypotheses(YieldHypotheses (&result)[kMaxAgents]) const;

  /// Futures of the watched vehicles. A future brakes for us (Mode::yields_percent is 100, else 0) where our path and its path cross.
  /// CORE-040 Every pose is finite; each vehicle's probabilities add up to 1 and it has at least one mode.
  /// CORE-041 A vehicle behind whose lane our plan enters slows down for us.
  /// CORE-042 Without plan we are taken to keep lane and speed only as far as we are in their way already,
  /// or have the right of way at a zone we are coming to.
  /// \param plan  our motion from start_ms, or null
  /// \param allowance  most work; vehicles it does not cover, the least relevant ones, are not in the set
  void decode(const Trajectory* plan, int allowance, PredictionSet& prediction) const;

  /// The same for one of them. \param ego  of this scene, lead and plan \pre index < scene.watched
  void decode_one(const EgoMotion& ego, int index, AgentPrediction& futures) const;

  /// CORE-043 "Keeps doing what it does": every agent along its likeliest path at constant speed; one without
  /// a path at constant yaw rate.
  void constant_velocity(KinematicSet& prediction) const;

  /// Work done since encode(), in agent-mode-steps (the unit of the stage's allowance). At most
  /// kMaxPredictionWork a decode.
  [[nodiscard]] int work() const { return work_; }

  /// The path hypotheses of the watched vehicles, as read in encode().
  [[nodiscard]] const PathHypothesis (&hypotheses() const)[kMaxAgents][kPathsPerAgent] { return hypotheses_; }

 private:
  const scene::Scene* scene_ = nullptr;
  const Parameters* parameters_ = nullptr;
  const YieldBeliefs* beliefs_ = nullptr;
  float lead_s_ = 0.0F;  ///< plan start minus scene time
  PathHypothesis hypotheses_[kMaxAgents][kPathsPerAgent];
  mutable int work_ = 0;
};

}  // namespace s4tp::satp
