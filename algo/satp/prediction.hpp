#pragma once
/// What others will do: the result every predictor gives.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/config.hpp"
#include "algo/core/geometry.hpp"

namespace s4tp::satp {

/// One future of one vehicle; steps[i] is its box centre at (i + 1) * kStepS after the scene's plan start.
struct Mode {
  float probability = 0.0F;
  std::uint8_t yields_percent = 0;  ///< how likely it lets us pass first, if that is how it drives
  std::uint16_t longest_step_cm =
      65535;  ///< upper bound of the way from a step to the next; so large: unknown
  Pose steps[kHorizonSteps];
};

/// Sets longest_step_cm from the steps.
void measure_steps(Mode& mode);

/// The futures of one vehicle. Probabilities of the modes add up to 1.
struct AgentPrediction {
  std::uint8_t agent = 0;                ///< index into Scene::agents
  BoundedVector<Mode, kMaxModes> modes;  ///< the likeliest first
};

/// Puts the likeliest mode first.
void likeliest_first(AgentPrediction& futures);

/// Futures of the watched vehicles, in the order of Scene::agents.
struct PredictionSet {
  bool conditioned = false;  ///< on our plan
  BoundedVector<AgentPrediction, kMaxAgents> agents;
};

/// The single kinematic future of every vehicle ("keeps doing what it does": lane, speed), for the check.
struct KinematicSet {
  BoundedVector<Mode, kMaxTracks> agents;  ///< in the order of Scene::agents
};

}  // namespace s4tp::satp
