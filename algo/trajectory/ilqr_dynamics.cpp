#include "algo/core/inline.hpp"
#include "algo/trajectory/ilqr_model.hpp"

namespace s4tp::trajectory {
namespace {

/// The smooth clamp and its slope: w t^2 (2 - t) meets 0 and u with their values and slopes.
float rest(float u_mps) {
  if (u_mps >= kRestBlendMps) return u_mps;
  if (u_mps <= 0.0F) return 0.0F;
  const float t = u_mps / kRestBlendMps;
  return kRestBlendMps * square(t) * (2.0F - t);
}

float rest_slope(float u_mps) {
  if (u_mps >= kRestBlendMps) return 1.0F;
  if (u_mps <= 0.0F) return 0.0F;
  const float t = u_mps / kRestBlendMps;
  return t * (4.0F - 3.0F * t);
}

float unclamped_speed(const MotionState& state, const MotionInput& input) {
  return state.speed_mps + kStepS * (state.acceleration_mps2 + 0.5F * kStepS * input.jerk_mps3);
}

}  // namespace

StateVector vector_of(const MotionState& state) {
  return (StateVector() << state.x_m, state.y_m, state.heading_rad, state.speed_mps, state.acceleration_mps2,
          state.curvature_1pm)
      .finished();
}

InputVector vector_of(const MotionInput& input) {
  return {input.jerk_mps3, input.curvature_rate_1pms};
}

MotionState motion_step(const MotionState& state, const MotionInput& input) {
  MotionState next;
  next.speed_mps = rest(unclamped_speed(state, input));
  next.acceleration_mps2 = state.acceleration_mps2 + kStepS * input.jerk_mps3;
  next.curvature_1pm = state.curvature_1pm + kStepS * input.curvature_rate_1pms;
  const float way_m = 0.5F * kStepS * (state.speed_mps + next.speed_mps);
  const float turn_rad = (state.curvature_1pm + 0.5F * kStepS * input.curvature_rate_1pms) * way_m;
  const SinCos middle = sin_cos(state.heading_rad + 0.5F * turn_rad);
  next.x_m = state.x_m + way_m * middle.cos;
  next.y_m = state.y_m + way_m * middle.sin;
  next.heading_rad = state.heading_rad + turn_rad;
  return next;
}

MotionJacobian motion_jacobian(const MotionState& state, const MotionInput& input) {
  const float unclamped_mps = unclamped_speed(state, input);
  const float way_m = 0.5F * kStepS * (state.speed_mps + rest(unclamped_mps));
  const float curvature_1pm = state.curvature_1pm + 0.5F * kStepS * input.curvature_rate_1pms;
  const float half_turn_rad = 0.5F * curvature_1pm * way_m;
  const SinCos middle = sin_cos(state.heading_rad + half_turn_rad);
  MotionJacobian jacobian;
  jacobian.turn = {-way_m * middle.sin, way_m * middle.cos};
  jacobian.way = {middle.cos - half_turn_rad * middle.sin, middle.sin + half_turn_rad * middle.cos,
                  curvature_1pm};
  jacobian.bend << 0.5F * way_m * jacobian.turn, way_m;
  jacobian.speed_gain = rest_slope(unclamped_mps);
  jacobian.way_by_speed = 0.5F * kStepS * (1.0F + jacobian.speed_gain);
  jacobian.way_by_acceleration = 0.5F * square(kStepS) * jacobian.speed_gain;
  return jacobian;
}

}  // namespace s4tp::trajectory
