#include "algo/trajectory/ilqr_backward.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {
namespace {

enum Index { kX = 0, kY, kPsi, kV, kA, kKappa };
enum Input { kJerk = 0, kRate };

using Vector = float[kMotionStates];
using Matrix = float[kMotionStates][kMotionStates];

/// Quadratic model of the cost to go: gradient . dx + 1/2 dx' hessian dx. The Hessian is symmetric.
struct CostToGo {
  Vector gradient = {};
  Matrix hessian = {};
};

/// Adds the cost of being in a state.
void add_state_cost(const StepExpansion& e, CostToGo& value) {
  const float gradient[kMotionStates] = {e.x, e.y, e.psi, e.v, e.a, e.kappa};
  for (int i = 0; i < kMotionStates; ++i) value.gradient[i] += gradient[i];
  Matrix& h = value.hessian;
  h[kX][kX] += e.xx;
  h[kX][kY] += e.xy;
  h[kX][kPsi] += e.x_psi;
  h[kY][kX] += e.xy;
  h[kY][kY] += e.yy;
  h[kY][kPsi] += e.y_psi;
  h[kPsi][kX] += e.x_psi;
  h[kPsi][kY] += e.y_psi;
  h[kPsi][kPsi] += e.psi_psi;
  h[kV][kV] += e.vv;
  h[kV][kKappa] += e.v_kappa;
  h[kKappa][kV] += e.v_kappa;
  h[kA][kA] += e.aa;
  h[kKappa][kKappa] += e.kappa_kappa;
}

/// A' m for one column m.
void transposed_times(const MotionJacobian& a, const Vector& m, Vector& result) {
  const float way = a.way.x * m[kX] + a.way.y * m[kY] + a.way.psi * m[kPsi];
  const float bend = a.bend.x * m[kX] + a.bend.y * m[kY] + a.bend.psi * m[kPsi];
  const float speed = a.speed_gain * m[kV];
  result[kX] = m[kX];
  result[kY] = m[kY];
  result[kPsi] = a.turn_x * m[kX] + a.turn_y * m[kY] + m[kPsi];
  result[kV] = a.way_by_speed * way + speed;
  result[kA] = a.way_by_acceleration * way + kStepS * speed + m[kA];
  result[kKappa] = bend + m[kKappa];
}

/// The model one step earlier, as a function of state and input there.
struct StepModel {
  Vector x;      ///< gradient by the state
  Matrix xx;     ///< its Hessian
  Vector ux[2];  ///< mixed: by jerk, by curvature rate
  float u[2];
  float uu[3];
};

void pull_back(const MotionJacobian& jacobian, const CostToGo& value, StepModel& model) {
  // Rows of P A transposed are columns of A' P, P being symmetric: column c of A gives row c here.
  const Matrix& p = value.hessian;
  Matrix pa;  // pa[c] = P A_c
  for (int r = 0; r < kMotionStates; ++r) {
    const float way = jacobian.way.x * p[kX][r] + jacobian.way.y * p[kY][r] + jacobian.way.psi * p[kPsi][r];
    const float bend =
        jacobian.bend.x * p[kX][r] + jacobian.bend.y * p[kY][r] + jacobian.bend.psi * p[kPsi][r];
    const float speed = jacobian.speed_gain * p[kV][r];
    pa[kX][r] = p[kX][r];
    pa[kY][r] = p[kY][r];
    pa[kPsi][r] = jacobian.turn_x * p[kX][r] + jacobian.turn_y * p[kY][r] + p[kPsi][r];
    pa[kV][r] = jacobian.way_by_speed * way + speed;
    pa[kA][r] = jacobian.way_by_acceleration * way + kStepS * speed + p[kA][r];
    pa[kKappa][r] = bend + p[kKappa][r];
  }
  for (int c = 0; c < kMotionStates; ++c) transposed_times(jacobian, pa[c], model.xx[c]);
  transposed_times(jacobian, value.gradient, model.x);

  // B_j = dt/2 (A_a + e_a), B_c = dt/2 (A_kappa + e_kappa).
  constexpr float kHalf = 0.5F * kStepS;
  for (int c = 0; c < kMotionStates; ++c) {
    model.ux[kJerk][c] = kHalf * (model.xx[c][kA] + pa[c][kA]);
    model.ux[kRate][c] = kHalf * (model.xx[c][kKappa] + pa[c][kKappa]);
  }
  model.u[kJerk] = kHalf * (model.x[kA] + value.gradient[kA]);
  model.u[kRate] = kHalf * (model.x[kKappa] + value.gradient[kKappa]);
  model.uu[0] = kHalf * kHalf * (model.xx[kA][kA] + 2.0F * pa[kA][kA] + p[kA][kA]);
  model.uu[1] = kHalf * kHalf * (model.xx[kA][kKappa] + pa[kKappa][kA] + pa[kA][kKappa] + p[kA][kKappa]);
  model.uu[2] = kHalf * kHalf * (model.xx[kKappa][kKappa] + 2.0F * pa[kKappa][kKappa] + p[kKappa][kKappa]);
}

void find_correction(const StepModel& model, const BoxStep& step, InputCorrection& correction) {
  const float determinant = model.uu[0] * model.uu[2] - model.uu[1] * model.uu[1];
  const bool both = step.free[kJerk] && step.free[kRate];
  const float by = 1.0F / determinant;
  const float by_jerk = 1.0F / model.uu[0];
  const float by_rate = 1.0F / model.uu[2];
  for (int k = 0; k < 2; ++k) correction.open[k] = step.u[k];
  for (int i = 0; i < kMotionStates; ++i) {
    const float jerk = model.ux[kJerk][i];
    const float rate = model.ux[kRate][i];
    if (both) {
      correction.feedback[kJerk][i] = (model.uu[1] * rate - model.uu[2] * jerk) * by;
      correction.feedback[kRate][i] = (model.uu[1] * jerk - model.uu[0] * rate) * by;
    } else {
      correction.feedback[kJerk][i] = step.free[kJerk] ? -jerk * by_jerk : 0.0F;
      correction.feedback[kRate][i] = step.free[kRate] ? -rate * by_rate : 0.0F;
    }
  }
}

/// With the correction put in, the terms in it cancel: what is left is linear in it.
void close_loop(const StepModel& model, const InputCorrection& correction, CostToGo& value) {
  for (int i = 0; i < kMotionStates; ++i) {
    value.gradient[i] = model.x[i] + model.ux[kJerk][i] * correction.open[kJerk] +
                        model.ux[kRate][i] * correction.open[kRate];
    for (int j = i; j < kMotionStates; ++j) {
      const float entry = model.xx[i][j] + model.ux[kJerk][i] * correction.feedback[kJerk][j] +
                          model.ux[kRate][i] * correction.feedback[kRate][j];
      value.hessian[i][j] = entry;
      value.hessian[j][i] = entry;
    }
  }
}

float model_value(const float (&h)[3], const float (&g)[2], float u, float w) {
  return 0.5F * (h[0] * u * u + h[2] * w * w) + h[1] * u * w + g[0] * u + g[1] * w;
}

}  // namespace

BoxStep box_step(const float (&h)[3], const float (&g)[2], const float (&low)[2], const float (&high)[2]) {
  const float by = 1.0F / (h[0] * h[2] - h[1] * h[1]);
  const float u = (h[1] * g[1] - h[2] * g[0]) * by;
  const float w = (h[1] * g[0] - h[0] * g[1]) * by;
  const bool u_inside = u >= low[0] && u <= high[0];
  const bool w_inside = w >= low[1] && w <= high[1];
  if (u_inside && w_inside) return {{u, w}, {true, true}};
  // The least lies on an edge that the free minimum is beyond; along an edge it is one-dimensional.
  BoxStep best = {{0.0F, 0.0F}, {false, false}};
  float least = 0.0F;
  bool found = false;
  if (!u_inside) {
    const float edge = u < low[0] ? low[0] : high[0];
    const float free = -(g[1] + h[1] * edge) / h[2];
    const float along = clamp(free, low[1], high[1]);
    best = {{edge, along}, {false, along == free}};
    least = model_value(h, g, edge, along);
    found = true;
  }
  if (!w_inside) {
    const float edge = w < low[1] ? low[1] : high[1];
    const float free = -(g[0] + h[1] * edge) / h[0];
    const float along = clamp(free, low[0], high[0]);
    const float value = model_value(h, g, along, edge);
    if (!found || value < least) best = {{along, edge}, {along == free, false}};
  }
  return best;
}

float backward_pass(const RefinementProblem& problem, const BoundState& bounds, const Motion& nominal,
                    float damping, InputCorrection (&corrections)[kHorizonSteps]) {
  CostToGo value;
  float promised = 0.0F;
  for (int i = kHorizonSteps - 1; i >= 0; --i) {
    const MotionInput& input = nominal.inputs[i];
    StepExpansion expansion;
    expand_step(problem, bounds, i, input, nominal.states[i + 1], expansion);
    add_state_cost(expansion, value);
    StepModel model;
    pull_back(motion_jacobian(nominal.states[i], input), value, model);
    model.u[kJerk] += expansion.jerk;
    model.u[kRate] += expansion.curvature_rate;
    // Both inputs are damped by the same share of what they cost anyway.
    model.uu[0] += (1.0F + damping) * expansion.jerk_jerk;
    model.uu[2] += (1.0F + damping) * expansion.rate_rate;

    const MotionInput& most = problem.steps[i].input_bound;
    const float low[2] = {-most.jerk_mps3 - input.jerk_mps3,
                          -most.curvature_rate_1pms - input.curvature_rate_1pms};
    const float high[2] = {most.jerk_mps3 - input.jerk_mps3,
                           most.curvature_rate_1pms - input.curvature_rate_1pms};
    const BoxStep step = box_step(model.uu, model.u, low, high);
    find_correction(model, step, corrections[i]);
    promised -= model_value(model.uu, model.u, step.u[0], step.u[1]);
    close_loop(model, corrections[i], value);
  }
  return max(0.0F, promised);
}

}  // namespace s4tp
