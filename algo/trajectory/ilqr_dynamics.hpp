#pragma once
/// Motion model of the optimizer: the kinematic bicycle of bicycle.hpp with jerk and curvature rate as
/// inputs.
///
/// \code
///   v' = rest(v + dt a + dt^2/2 j)      a' = a + dt j      kappa' = kappa + dt c
///   s  = dt (v + v') / 2                way of the step
///   k  = kappa + dt/2 c                 curvature at its middle
///   psi' = psi + k s                    x' = x + s cos(psi + k s / 2)     y' = y + s sin(psi + k s / 2)
/// \endcode
/// rest(u) is u from kRestBlendMps on and 0 below 0, with a cubic between that has no kink: v never becomes
/// negative, and standing still is a fixed point of the model and of its derivatives.

#include "algo/core/config.hpp"
#include "algo/core/trajectory.hpp"

namespace s4tp::trajectory {

inline constexpr float kRestBlendMps = 0.1F;

struct MotionState {
  float x_m = 0.0F;  ///< of the rear axle
  float y_m = 0.0F;
  float heading_rad = 0.0F;  ///< not wrapped
  float speed_mps = 0.0F;    ///< >= 0
  float acceleration_mps2 = 0.0F;
  float curvature_1pm = 0.0F;
};

struct MotionInput {
  float jerk_mps3 = 0.0F;
  float curvature_rate_1pms = 0.0F;  ///< 1/(m s)
};

/// states[i] is i * kStepS after the start; inputs[i] leads from it to the next one.
struct Motion {
  MotionState states[kTrajectoryPoints];
  MotionInput inputs[kHorizonSteps];
};

/// One step of kStepS.
[[nodiscard]] MotionState motion_step(const MotionState& state, const MotionInput& input);

}  // namespace s4tp::trajectory
