#pragma once
/// The network's second half: from a vehicle's state to its futures, without our plan or for a plan.

#include "algo/satp/encoder.hpp"

namespace s4tp::satp {

/// The futures of one vehicle in its own frame; pose i at (i + 1) * kStepS after plan start.
struct Futures {
  float probability[kMcuShape.modes];
  Pose poses[kMcuShape.modes][kHorizonSteps];
};

/// SATP-032 Every pose is finite and within 300 m; probabilities are in 0 .. 1 and add up to 1.
/// SATP-033 Without a plan nothing of a plan enters; with a gate of 0 a plan and none differ by nothing but
/// what the training gave the null vector.
/// \param plan  PlanInput::step of the vehicle, or null \pre hdv < encoded.hdvs
void decode(const Weights& weights, const Encoded& encoded, int hdv, const float (*plan)[kPlanValues],
            Futures& futures);

}  // namespace s4tp::satp
