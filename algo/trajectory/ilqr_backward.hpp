#pragma once
/// Backward pass of the optimizer: quadratic model of the cost to go, step by step from the end, and the
/// input corrections that minimize it within their bounds.

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp {

inline constexpr int kMotionStates = 6;  ///< x, y, psi, v, a, kappa

/// Correction of one input: `open` + feedback . (state - nominal state).
struct InputCorrection {
  float open[2];  ///< jerk, curvature rate
  float feedback[2][kMotionStates];
};

/// Least of 1/2 u'Hu + g'u within [low, high]; H positive definite.
struct BoxStep {
  float u[2];
  bool free[2];  ///< not at a bound
};
[[nodiscard]] BoxStep box_step(const float (&hessian)[3], const float (&gradient)[2], const float (&low)[2],
                               const float (&high)[2]);  ///< hessian: uu, uw, ww

/// \param damping  added to the inputs' Hessian: shorter steps
/// \return the decrease of step_merit's sum that the model promises for full corrections, >= 0
[[nodiscard]] float backward_pass(const RefinementProblem& problem, const BoundState& bounds,
                                  const Motion& nominal, float damping,
                                  InputCorrection (&corrections)[kHorizonSteps]);

}  // namespace s4tp
