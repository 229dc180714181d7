/// The integral's gradient by the driver's state, differentiated under the integral.

#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/box_slices.hpp"
#include "algo/sadrf/slices.hpp"

namespace s4tp::sadrf {
namespace {

/// Integrals of t^n exp(-t^2 / (2 sigma^2)) from 0 to e, n = 0 .. 3.
struct Moments {
  float m0;
  float m1;
  float m2;
  float m3;
};

Moments moments(float e_m, float sigma_m) {
  const float variance = square(sigma_m);
  const float bell = exp(-0.5F * square(e_m) / variance);
  Moments of;
  of.m0 = gauss_integral(e_m, sigma_m);
  of.m1 = variance * (1.0F - bell);
  of.m2 = variance * (of.m0 - e_m * bell);
  of.m3 = variance * (2.0F * of.m1 - square(e_m) * bell);
  return of;
}

/// The field along its path, and how it changes with s and with the look-ahead distance.
struct Height {
  float value;
  float by_s;
  float by_look_ahead;
};

Height height_at(const Field& field, float s_m) {
  const float left_m = field.look_ahead_m - s_m;
  const float whole = field.steepness * square(left_m);
  const float fall = 2.0F * field.steepness * left_m;
  if (s_m >= field.ramp_m) return {whole, -fall, fall};
  const float x = s_m / field.ramp_m;
  const float ramp = square(x) * (3.0F - 2.0F * x);
  return {ramp * whole, 6.0F * x * (1.0F - x) / field.ramp_m * whole - ramp * fall, ramp * fall};
}

/// What the gradient is made of, in the field's frame.
struct Sums {
  float value = 0.0F;
  float ahead = 0.0F;    ///< by a shift of the car along its x
  float left = 0.0F;     ///< along its y
  float heading = 0.0F;  ///< by a turn to the left
  float look_ahead = 0.0F;
  float curvature = 0.0F;
  float widening_left = 0.0F;
  float widening_right = 0.0F;
};

/// How s and e of a fixed point change: s' (1 - kappa e) = s0 + s1 e, and e' = e0.
struct Rates {
  float s0;
  float s1;
  float e0;
};

struct AllRates {
  Rates ahead;
  Rates left;
  Rates heading;
  Rates curvature;
};

AllRates rates(const Field& field, const Slice& slice) {
  const Point t = slice.tangent;
  const float w = field.curvature_1pm * slice.s_m;
  // The foot moves by s^2 (w - sin w) / w^2 along and s^2 (1 - cos w) / w^2 to the left per curvature.
  float along = 0.0F;
  float across = 0.0F;
  if (abs(w) < 0.5F) {
    const float w2 = square(w);
    along = w * (1.0F / 6.0F - w2 * (1.0F / 120.0F - w2 * (1.0F / 5040.0F)));
    across = 0.5F - w2 * (1.0F / 24.0F - w2 * (1.0F / 720.0F));
  } else {
    const SinCos turned = sin_cos(w);
    along = (w - turned.sin) / square(w);
    across = (1.0F - turned.cos) / square(w);
  }
  const float s2 = square(slice.s_m);
  return {{-t.x_m, 0.0F, t.y_m},
          {-t.y_m, 0.0F, -t.x_m},
          {cross(t, slice.foot), 1.0F, -dot(slice.foot, t)},
          {-s2 * along, slice.s_m, -s2 * across}};
}

/// The part of a slice to one side of the path.
struct Half {
  Moments j;
  float sigma_m;
  float widening;
};

Half half_of(const Slice& slice, bool left_side, const Field& field) {
  const float from_m = left_side ? max(slice.right_m, 0.0F) : min(slice.right_m, 0.0F);
  const float to_m = left_side ? max(slice.left_m, 0.0F) : min(slice.left_m, 0.0F);
  const float widening = left_side ? field.widening_left : field.widening_right;
  const float sigma_m = widening * slice.s_m + field.base_width_m;
  Half half = {{0.0F, 0.0F, 0.0F, 0.0F}, sigma_m, widening};
  if (to_m <= from_m) return half;
  const Moments to = moments(to_m, sigma_m);
  const Moments from = moments(from_m, sigma_m);
  half.j = {to.m0 - from.m0, to.m1 - from.m1, to.m2 - from.m2, to.m3 - from.m3};
  return half;
}

void add_slice(const Field& field, float weight, const Slice& slice, Sums& sums) {
  const AllRates rate = rates(field, slice);
  const float kappa = field.curvature_1pm;
  const Height at = height_at(field, slice.s_m);
  const float height = weight * at.value;
  const float by_s = weight * at.by_s;
  for (int side = 0; side < 2; ++side) {
    const Half half = half_of(slice, side == 0, field);
    const Moments& j = half.j;
    if (j.m0 <= 0.0F) continue;
    const float per_variance = 1.0F / square(half.sigma_m);
    const float spread = height * per_variance / half.sigma_m;
    const auto by = [&](const Rates& r) {
      return by_s * (r.s0 * j.m0 + r.s1 * j.m1) + spread * half.widening * (r.s0 * j.m2 + r.s1 * j.m3) -
             height * per_variance * r.e0 * (j.m1 - kappa * j.m2);
    };
    sums.value += height * (j.m0 - kappa * j.m1);
    sums.ahead += by(rate.ahead);
    sums.left += by(rate.left);
    sums.heading += by(rate.heading);
    sums.curvature += by(rate.curvature);
    sums.look_ahead += weight * at.by_look_ahead * (j.m0 - kappa * j.m1);
    (side == 0 ? sums.widening_left : sums.widening_right) += spread * slice.s_m * (j.m2 - kappa * j.m3);
  }
}

/// The field begins with a step: what enters or leaves the box at that line when the car moves. The line
/// stands still when only the steering changes.
void add_step(const Field& field, const LocalBox& box, float s_m, float sign, Sums& sums) {
  Slice slice;
  if (!cut(field, box, s_m, slice)) return;
  const AllRates rate = rates(field, slice);
  const float height = sign * field.steepness * square(field.look_ahead_m - s_m);
  for (int side = 0; side < 2; ++side) {
    const Moments j = half_of(slice, side == 0, field).j;
    sums.ahead += height * (rate.ahead.s0 * j.m0 + rate.ahead.s1 * j.m1);
    sums.left += height * (rate.left.s0 * j.m0 + rate.left.s1 * j.m1);
    sums.heading += height * (rate.heading.s0 * j.m0 + rate.heading.s1 * j.m1);
  }
}

}  // namespace

FieldSlopes field_slopes(const FieldParams& params, float speed_mps, float curvature_1pm, float steering_rad,
                         float wheelbase_m) {
  const bool moving = speed_mps * params.look_ahead_s > kShortestLookAheadM;
  // |delta| has no derivative at 0; 0 lies between those of both sides.
  const float blend_rad = params.smoothing.steering_rad;
  const float sign = steering_rad > 0.0F ? 1.0F : (steering_rad < 0.0F ? -1.0F : 0.0F);
  const float by_steering =
      blend_rad > 0.0F ? steering_rad / sqrt(square(steering_rad) + square(blend_rad)) : sign;
  const float left = steering_rad > 0.0F ? params.widening_inner : params.widening_outer;
  const float right = steering_rad > 0.0F ? params.widening_outer : params.widening_inner;
  return {moving ? params.look_ahead_s : 0.0F,
          1.0F / wheelbase_m + wheelbase_m * square(curvature_1pm),  // d tan = 1 + tan^2
          by_steering * left, by_steering * right};
}

float field_over_slices(const Field& field, const Box& box, const FieldSlopes& slopes,
                        FieldGradient& gradient, int& lines) {
  const LocalBox local = in_frame(field, box);
  Sums sums;
  lines = 0;
  for_slices(field, local, [&](float weight, const Slice& slice) {
    add_slice(field, weight, slice, sums);
    ++lines;
  });
  if (field.ramp_m <= 0.0F) add_step(field, local, 0.0F, 1.0F, sums);
  const float end_m = longest_arc_m(field);
  if (end_m < field.look_ahead_m) add_step(field, local, end_m, -1.0F, sums);
  gradient.x = field.ahead.x_m * sums.ahead - field.ahead.y_m * sums.left;
  gradient.y = field.ahead.y_m * sums.ahead + field.ahead.x_m * sums.left;
  gradient.heading = sums.heading;
  gradient.speed = slopes.look_ahead_s * sums.look_ahead;
  gradient.steering = slopes.curvature_1pm * sums.curvature +
                      slopes.widening_left_1prad * sums.widening_left +
                      slopes.widening_right_1prad * sums.widening_right;
  return max(sums.value, 0.0F);
}

}  // namespace s4tp::sadrf
