#pragma once
/// Backward pass of the optimizer: quadratic model of the cost to go, step by step from the end, and the
/// input corrections that minimize it within their bounds. Internal: Eigen is for no installed header.

#include "algo/trajectory/ilqr_model.hpp"

namespace s4tp::trajectory {

/// Least of 1/2 u'Hu + g'u within [low, high]; H positive definite.
struct BoxStep {
  InputVector u;
  bool free[2];  ///< not at a bound
};
[[nodiscard]] BoxStep box_step(const InputMatrix& hessian, const InputVector& gradient,
                               const InputVector& low, const InputVector& high);

/// \param damping  added to the inputs' Hessian: shorter steps
/// \return the decrease of step_merit's sum that the model promises for full corrections, >= 0
[[nodiscard]] float backward_pass(const RefinementProblem& problem, const BoundState& bounds,
                                  const Motion& nominal, float damping,
                                  InputCorrection (&corrections)[kHorizonSteps]);

}  // namespace s4tp::trajectory
