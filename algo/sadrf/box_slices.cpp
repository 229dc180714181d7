#include "algo/sadrf/box_slices.hpp"

#include "algo/core/bounded.hpp"
#include "algo/core/inline.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/path_coordinates.hpp"

namespace s4tp::sadrf {
namespace {

/// The box in the field's frame.
struct LocalBox {
  Point centre;
  Point axis;  ///< unit vector of its heading
  float half_length_m;
  float half_width_m;
};

/// A line across the path: foot and unit tangent of the path at s, and the part of it inside the box.
struct Slice {
  float s_m;
  Point foot;
  Point tangent;
  float right_m;  ///< e at its ends
  float left_m;
};

LocalBox in_frame(const Field& field, const Box& box) {
  const Point offset = position(box.centre) - field.origin;
  const Point axis = direction(box.centre.heading_rad);
  return {{dot(field.ahead, offset), cross(field.ahead, offset)},
          {dot(field.ahead, axis), cross(field.ahead, axis)},
          0.5F * box.length_m,
          0.5F * box.width_m};
}

/// Half a turn: beyond, points belong to the path's other side.
float longest_arc_m(const Field& field) {
  constexpr float kStraight_1pm = 1e-4F;
  const float magnitude = abs(field.curvature_1pm);
  return magnitude < kStraight_1pm ? field.look_ahead_m : min(field.look_ahead_m, kPi / magnitude);
}

/// A corner of the box in path coordinates; the arc length counts on through the ray behind the turn's centre
/// instead of jumping there.
struct Corner {
  float s_m;
  float e_m;
};

Corner corner(const Field& field, Point point) {
  const PathCoordinates at = path_coordinates(field.curvature_1pm, point.x_m, point.y_m);
  const bool behind_centre = at.s_m < 0.0F && field.curvature_1pm * point.y_m > 1.0F;
  return {behind_centre ? at.s_m + kTwoPi / abs(field.curvature_1pm) : at.s_m, at.e_m};
}

/// The path at s: sin and 1 - cos over kappa, by their series where kappa s is small.
void follow(const Field& field, float s_m, Slice& slice) {
  const float turned_rad = field.curvature_1pm * s_m;
  slice.s_m = s_m;
  if (abs(turned_rad) < 0.5F) {
    const float w2 = square(turned_rad);
    const float sinc = 1.0F + w2 * (-1.0F / 6.0F + w2 * (1.0F / 120.0F - w2 * (1.0F / 5040.0F)));
    const float versed = 0.5F + w2 * (-1.0F / 24.0F + w2 * (1.0F / 720.0F - w2 * (1.0F / 40320.0F)));
    slice.tangent = {1.0F - w2 * versed, turned_rad * sinc};
    slice.foot = {s_m * sinc, s_m * turned_rad * versed};
    return;
  }
  const SinCos turned = sin_cos(turned_rad);
  const float radius_m = 1.0F / field.curvature_1pm;
  slice.tangent = {turned.cos, turned.sin};
  slice.foot = {radius_m * turned.sin, radius_m * (1.0F - turned.cos)};
}

/// Keeps the part of the slice where |value + slope * e| <= half.
void clip(float value, float slope, float half, Slice& slice) {
  constexpr float kParallel = 1e-6F;
  if (abs(slope) < kParallel) {
    if (abs(value) > half) slice.left_m = slice.right_m;
    return;
  }
  const float per = 1.0F / slope;
  const float middle = -value * per;
  const float reach = abs(half * per);
  slice.right_m = max(slice.right_m, middle - reach);
  slice.left_m = min(slice.left_m, middle + reach);
}

/// \return false when the line misses the box
bool cut(const Field& field, const LocalBox& box, float s_m, Slice& slice) {
  follow(field, s_m, slice);
  const float left_reach_m = 6.0F * (field.widening_left * s_m + field.base_width_m);
  const float right_reach_m = 6.0F * (field.widening_right * s_m + field.base_width_m);
  slice.right_m = -right_reach_m;
  slice.left_m = left_reach_m;
  // Not beyond the centre of the turn.
  if (field.curvature_1pm * left_reach_m > 1.0F) slice.left_m = 1.0F / field.curvature_1pm;
  if (field.curvature_1pm * right_reach_m < -1.0F) slice.right_m = 1.0F / field.curvature_1pm;
  const Point normal = {-slice.tangent.y_m, slice.tangent.x_m};
  const Point offset = slice.foot - box.centre;
  clip(dot(box.axis, offset), dot(box.axis, normal), box.half_length_m, slice);
  clip(cross(box.axis, offset), cross(box.axis, normal), box.half_width_m, slice);
  return slice.left_m > slice.right_m;
}

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

float sigma_at(const Field& field, float s_m, float e_m) {
  return (e_m > 0.0F ? field.widening_left : field.widening_right) * s_m + field.base_width_m;
}

/// Integral over the slice of exp(-e^2 / (2 sigma^2)) times the area's own measure, 1 - kappa e.
float across(const Field& field, const Slice& slice) {
  const float left_sigma_m = sigma_at(field, slice.s_m, slice.left_m);
  const float right_sigma_m = sigma_at(field, slice.s_m, slice.right_m);
  const float straight =
      gauss_integral(slice.left_m, left_sigma_m) - gauss_integral(slice.right_m, right_sigma_m);
  constexpr float kNoBend = 1e-5F;
  if (abs(field.curvature_1pm) < kNoBend) return straight;
  const auto first = [](float e_m, float sigma_m) {
    const float variance = square(sigma_m);
    return variance * (1.0F - exp(-0.5F * square(e_m) / variance));
  };
  return straight -
         field.curvature_1pm * (first(slice.left_m, left_sigma_m) - first(slice.right_m, right_sigma_m));
}

struct GaussRule {
  int count;
  float nodes[4];
  float weights[4];
};

const GaussRule& rule_for(float half_m) {
  static constexpr GaussRule kRules[] = {
      {1, {0.0F, 0.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F, 0.0F}},
      {2, {-0.577350269F, 0.577350269F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F, 0.0F}},
      {3, {-0.774596669F, 0.0F, 0.774596669F, 0.0F}, {0.555555556F, 0.888888889F, 0.555555556F, 0.0F}},
      {4,
       {-0.861136312F, -0.339981044F, 0.339981044F, 0.861136312F},
       {0.347854845F, 0.652145155F, 0.652145155F, 0.347854845F}}};
  if (half_m < 0.05F) return kRules[0];
  if (half_m < 0.25F) return kRules[1];
  return kRules[half_m < 0.8F ? 2 : 3];
}

/// Where the lines' sum is cut into pieces: at the corners, and where an edge enters or leaves the middle of
/// the field; from one to the other what is summed is smooth.
using Breaks = BoundedVector<float, 13>;
static_assert(kMaxSlices == 4 * (Breaks::kCapacity - 1));

void insert(float s_m, Breaks& breaks) {
  if (!breaks.push(s_m)) return;
  for (int i = breaks.size() - 1; i > 0 && breaks[i] < breaks[i - 1]; --i) {
    breaks[i] = breaks[i - 1];
    breaks[i - 1] = s_m;
  }
}

void add_crossing(const Field& field, const Corner& from, const Corner& to, float side, Breaks& breaks) {
  constexpr float kMiddle = 2.0F;  // sigma
  const float sigma_m = sigma_at(field, max(0.5F * (from.s_m + to.s_m), 0.0F), side);
  const float level_m = side * kMiddle * sigma_m;
  const float before_m = level_m - from.e_m;
  const float after_m = to.e_m - level_m;
  if (before_m * after_m <= 0.0F) return;
  insert(from.s_m + (to.s_m - from.s_m) * before_m / (before_m + after_m), breaks);
}

Breaks find_breaks(const Field& field, const LocalBox& box) {
  const Point ahead = box.half_length_m * box.axis;
  const Point left = box.half_width_m * Point{-box.axis.y_m, box.axis.x_m};
  const Corner corners[] = {
      corner(field, box.centre - ahead - left), corner(field, box.centre + ahead - left),
      corner(field, box.centre + ahead + left), corner(field, box.centre - ahead + left)};
  constexpr float kAcrossM = 0.2F;
  Breaks breaks;
  for (int i = 0; i < 4; ++i) {
    const Corner& from = corners[i];
    const Corner& to = corners[(i + 1) % 4];
    insert(from.s_m, breaks);
    if (abs(to.s_m - from.s_m) < kAcrossM) continue;
    add_crossing(field, from, to, -1.0F, breaks);
    add_crossing(field, from, to, 1.0F, breaks);
  }
  if (breaks[0] < field.ramp_m && field.ramp_m < breaks[breaks.size() - 1]) insert(field.ramp_m, breaks);
  return breaks;
}

/// Calls add(weight, slice) for every line whose sum approximates the integral over the box.
template <typename Add>
void for_slices(const Field& field, const LocalBox& box, const Add& add) {
  const float end_m = longest_arc_m(field);
  const Breaks breaks = find_breaks(field, box);
  for (int i = 0; i + 1 < breaks.size(); ++i) {
    const float from_m = max(breaks[i], 0.0F);
    const float to_m = min(breaks[i + 1], end_m);
    const float half_m = 0.5F * (to_m - from_m);
    if (half_m <= 0.0F) continue;
    const GaussRule& rule = rule_for(half_m);
    for (int k = 0; k < rule.count; ++k) {
      Slice slice;
      if (cut(field, box, from_m + half_m * (1.0F + rule.nodes[k]), slice)) {
        add(half_m * rule.weights[k], slice);
      }
    }
  }
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
  float aside = 0.0F;
  if (abs(w) < 0.5F) {
    const float w2 = square(w);
    along = w * (1.0F / 6.0F - w2 * (1.0F / 120.0F - w2 * (1.0F / 5040.0F)));
    aside = 0.5F - w2 * (1.0F / 24.0F - w2 * (1.0F / 720.0F));
  } else {
    const SinCos turned = sin_cos(w);
    along = (w - turned.sin) / square(w);
    aside = (1.0F - turned.cos) / square(w);
  }
  const float s2 = square(slice.s_m);
  return {{-t.x_m, 0.0F, t.y_m},
          {-t.y_m, 0.0F, -t.x_m},
          {cross(t, slice.foot), 1.0F, -dot(slice.foot, t)},
          {-s2 * along, slice.s_m, -s2 * aside}};
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

float field_over_slices(const Field& field, const Box& box) {
  int lines = 0;
  return field_over_slices(field, box, lines);
}

float field_over_slices(const Field& field, const Box& box, int& lines) {
  float sum = 0.0F;
  lines = 0;
  for_slices(field, in_frame(field, box), [&](float weight, const Slice& slice) {
    sum += weight * square(field.look_ahead_m - slice.s_m) * across(field, slice);
    ++lines;
  });
  return field.steepness * max(sum, 0.0F);
}

float field_over_slices(const Field& field, const Box& box, const FieldSlopes& slopes,
                        FieldGradient& gradient) {
  const LocalBox local = in_frame(field, box);
  Sums sums;
  for_slices(field, local, [&](float weight, const Slice& slice) { add_slice(field, weight, slice, sums); });
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
