#pragma once
/// Local models of the optimizer's problem, as vectors and matrices. Internal: Eigen is for no installed
/// header.

#include "algo/core/linear_algebra.hpp"
#include "algo/trajectory/ilqr.hpp"

namespace s4tp::trajectory {

using StateVector = Vector<kMotionStates>;  ///< x, y, psi, v, a, kappa
using InputVector = Vector<2>;              ///< jerk, curvature rate
using StateMatrix = Matrix<kMotionStates, kMotionStates>;
using InputMatrix = Matrix<2, 2>;
using InputByState = Matrix<2, kMotionStates>;

enum StateIndex { kX = 0, kY, kPsi, kV, kA, kKappa };
enum InputIndex { kJerk = 0, kRate };

[[nodiscard]] StateVector vector_of(const MotionState& state);
[[nodiscard]] InputVector vector_of(const MotionInput& input);

/// Derivatives of a step by their non-trivial entries, w_v and w_a being way_by_..., g speed_gain:
///
/// \code
///          x  y  psi       v            a            kappa
///   x'     1  .  turn[0]   w_v way[0]   w_a way[0]   bend[0]       B's columns follow from A's:
///   y'     .  1  turn[1]   w_v way[1]   w_a way[1]   bend[1]         B_j = dt/2 (A_a + e_a)
///   psi'   .  .  1         w_v way[2]   w_a way[2]   bend[2]         B_c = dt/2 (A_kappa + e_kappa)
///   v'     .  .  .         g            g dt         .
///   a'     .  .  .         .            1            .
///   kappa' .  .  .         .            .            1
/// \endcode
struct MotionJacobian {
  Vector<2> turn;
  Vector<3> way;   ///< by the way of the step
  Vector<3> bend;  ///< by the curvature
  float way_by_speed;
  float way_by_acceleration;
  float speed_gain;
};
[[nodiscard]] MotionJacobian motion_jacobian(const MotionState& state, const MotionInput& input);

/// Quadratic model of a cost by the state: gradient . dx + 1/2 dx' hessian dx. The Hessian is symmetric.
struct StateCost {
  StateVector gradient;
  StateMatrix hessian;
};

/// Adds gradient and Gauss-Newton Hessian of step_merit by states[index + 1].
void add_step_cost(const RefinementProblem& problem, const BoundState& bounds, int index,
                   const MotionState& state, StateCost& cost);

/// Gradient and, being diagonal, Hessian of step_merit by inputs[index].
struct InputCost {
  InputVector gradient;
  InputVector hessian;
};
[[nodiscard]] InputCost input_cost(const RefinementProblem& problem, int index, const MotionInput& input);

}  // namespace s4tp::trajectory
