#pragma once
/// What enters one GRU step: where the vehicle has come to, and our plan as seen from there.

#include "algo/satp/network_input.hpp"

namespace s4tp::satp {

/// Where the decoding of one future stands, in the vehicle's frame.
struct StepState {
  Pose last;                    ///< the last predicted pose
  float velocity_x_mps = 0.0F;  ///< mean over the last GRU step; before the first one (v0, 0)
  float velocity_y_mps = 0.0F;
};

/// x, y, sin, cos, v_x, v_y, v0, time; not yet divided by kOwnUnit. \param step  GRU step, 0 the first
void own_features(const StepState& state, float speed_mps, int step, float (&features)[kOwnFeatures]);

/// Begin x, y; end x, y, sin, cos: from the last predicted pose; speed, entry, exit; zone, yields, priority.
/// \param plan  PlanInput::step of the vehicle and step \param pair  NetworkInput::pair of the vehicle
void plan_features(const StepState& state, const float (&plan)[kPlanValues],
                   const float (&pair)[kPairFeatures], float (&features)[kPlanFeatures]);

}  // namespace s4tp::satp
