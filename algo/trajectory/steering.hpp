#pragma once
/// Steering back to a line from wherever and however we stand: one step of a bicycle whose driver turns the
/// wheel towards the line as fast and as far as it goes. It can be driven from any state, so it stands in
/// where no smooth lateral motion (roll_out.hpp) fits: half turned in a tight corner, wheels locked over.

#include "algo/core/trajectory.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {

/// What all steps share: a part of what the vehicle can do is left to follow the plan with.
struct SteeringLimits {
  float lateral_mps2;
  float curvature_1pm;
  float slew_1pm;  ///< change of curvature in a step
};
[[nodiscard]] SteeringLimits steering_limits(const Parameters& parameters);

/// Moves `point` by `way_m` > 0 within one step of kStepS: pose and curvature; speed as it is given in
/// `point`. \param s_m  arc length of `point` on the line; receives the new one
void steer_step(const ReferenceLine& line, float way_m, const SteeringLimits& limits, float& s_m,
                TrajectoryPoint& point);

}  // namespace s4tp::trajectory
