#include "algo/trajectory/ilqr_backward.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kHalfStepS = 0.5F * kStepS;

/// M A, column by column; A' M for a symmetric M is its transpose.
template <typename M>
auto times(const M& m, const MotionJacobian& a) {
  constexpr int kRows = M::RowsAtCompileTime;
  const auto pose = m.template leftCols<3>();
  const Vector<kRows> by_way = pose.lazyProduct(a.way);
  const Vector<kRows> by_speed = a.speed_gain * m.col(kV);
  Matrix<kRows, kMotionStates> result;
  result.col(kX) = m.col(kX);
  result.col(kY) = m.col(kY);
  result.col(kPsi) = m.template leftCols<2>().lazyProduct(a.turn) + m.col(kPsi);
  result.col(kV) = a.way_by_speed * by_way + by_speed;
  result.col(kA) = a.way_by_acceleration * by_way + kStepS * by_speed + m.col(kA);
  result.col(kKappa) = pose.lazyProduct(a.bend) + m.col(kKappa);
  return result;
}

/// The cost to go one step earlier, as a function of state and input there.
struct StepModel {
  StateCost state;
  InputVector u;
  InputMatrix uu;
  InputByState ux;
};

StepModel pull_back(const MotionJacobian& jacobian, const StateCost& next) {
  const StateMatrix pa = times(next.hessian, jacobian);
  StepModel model = {
      {times(next.gradient.transpose(), jacobian).transpose(), times(pa.transpose(), jacobian)}, {}, {}, {}};
  // B = dt/2 (A + E) in its last two columns, E being those of the identity; with them, P B = dt/2 (P A + P).
  const InputByState apa = model.state.hessian.bottomRows<2>();
  const Matrix<2, 2> corner = pa.bottomRightCorner<2, 2>();
  model.ux = kHalfStepS * (apa + pa.bottomRows<2>());
  model.u = kHalfStepS * (model.state.gradient.tail<2>() + next.gradient.tail<2>());
  model.uu = (kHalfStepS * kHalfStepS) *
             (apa.rightCols<2>() + corner + corner.transpose() + next.hessian.bottomRightCorner<2, 2>());
  return model;
}

float value_of(const InputMatrix& hessian, const InputVector& gradient, const InputVector& u) {
  return u.dot(0.5F * (hessian * u) + gradient);
}

/// \return feedback . (state - nominal state)
InputByState feedback_of(const StepModel& model, const BoxStep& step) {
  InputMatrix inverse = model.uu.inverse();
  if (!step.free[kJerk] || !step.free[kRate]) {
    inverse << (step.free[kJerk] ? 1.0F / model.uu(kJerk, kJerk) : 0.0F), 0.0F, 0.0F,
        (step.free[kRate] ? 1.0F / model.uu(kRate, kRate) : 0.0F);
  }
  return -inverse * model.ux;
}

/// With the correction put in, the terms in it cancel: what is left is linear in it.
void close_loop(const StepModel& model, const InputVector& open, const InputByState& feedback,
                StateCost& cost) {
  cost.gradient = model.state.gradient + model.ux.transpose().lazyProduct(open);
  cost.hessian = model.state.hessian + model.ux.transpose().lazyProduct(feedback);
}

}  // namespace

BoxStep box_step(const InputMatrix& hessian, const InputVector& gradient, const InputVector& low,
                 const InputVector& high) {
  const InputVector least = -(hessian.inverse() * gradient);
  BoxStep best = {least, {true, true}};
  bool inside = true;
  float best_value = 0.0F;
  // The least lies on an edge that the free minimum is beyond; along an edge it is one-dimensional.
  for (int k = 0; k < 2; ++k) {
    const float edge = clamp(least[k], low[k], high[k]);
    if (edge == least[k]) continue;
    const int other = 1 - k;
    const float free = -(gradient[other] + hessian(0, 1) * edge) / hessian(other, other);
    BoxStep step;
    step.u[k] = edge;
    step.u[other] = clamp(free, low[other], high[other]);
    step.free[k] = false;
    step.free[other] = step.u[other] == free;
    const float value = value_of(hessian, gradient, step.u);
    if (!inside && value >= best_value) continue;
    best = step;
    best_value = value;
    inside = false;
  }
  return best;
}

float backward_pass(const RefinementProblem& problem, const BoundState& bounds, const Motion& nominal,
                    float damping, InputCorrection (&corrections)[kHorizonSteps]) {
  StateCost to_go = {StateVector::Zero(), StateMatrix::Zero()};
  float promised = 0.0F;
  for (int i = kHorizonSteps - 1; i >= 0; --i) {
    const MotionInput& input = nominal.inputs[i];
    add_step_cost(problem, bounds, i, nominal.states[i + 1], to_go);
    StepModel model = pull_back(motion_jacobian(nominal.states[i], input), to_go);
    const InputCost own = input_cost(problem, i, input);
    model.u += own.gradient;
    model.uu.diagonal() += (1.0F + damping) * own.hessian;  // both damped by the same share

    const InputVector most = vector_of(problem.steps[i].input_bound);
    const InputVector at = vector_of(input);
    const BoxStep step = box_step(model.uu, model.u, -most - at, most - at);
    const InputByState feedback = feedback_of(model, step);
    promised -= value_of(model.uu, model.u, step.u);
    close_loop(model, step.u, feedback, to_go);
    Eigen::Map<InputVector>(corrections[i].open) = step.u;
    Eigen::Map<InputByState>(corrections[i].feedback) = feedback;
  }
  return max(0.0F, promised);
}

}  // namespace s4tp::trajectory
