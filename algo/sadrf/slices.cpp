#include "algo/sadrf/slices.hpp"

#include "algo/sadrf/path_coordinates.hpp"

namespace s4tp::sadrf {
namespace {

constexpr float kReachSigmas = 6.0F;  // beyond, there is no field to speak of
// Half a slice this short, or shorter, needs one, two or three nodes.
constexpr float kOneNodeM = 0.05F;
constexpr float kTwoNodesM = 0.25F;
constexpr float kThreeNodesM = 0.8F;

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

}  // namespace

LocalBox in_frame(const Field& field, const Box& box) {
  const Point offset = position(box.centre) - field.origin;
  const Point axis = direction(box.centre.heading_rad);
  return {{dot(field.ahead, offset), cross(field.ahead, offset)},
          {dot(field.ahead, axis), cross(field.ahead, axis)},
          0.5F * box.length_m,
          0.5F * box.width_m};
}

float longest_arc_m(const Field& field) {
  constexpr float kStraight_1pm = 1e-4F;
  const float magnitude = abs(field.curvature_1pm);
  return magnitude < kStraight_1pm ? field.look_ahead_m : min(field.look_ahead_m, kPi / magnitude);
}

bool cut(const Field& field, const LocalBox& box, float s_m, Slice& slice) {
  follow(field, s_m, slice);
  const float left_reach_m = kReachSigmas * (field.widening_left * s_m + field.base_width_m);
  const float right_reach_m = kReachSigmas * (field.widening_right * s_m + field.base_width_m);
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

const GaussRule& rule_for(float half_m) {
  static constexpr GaussRule kRules[] = {
      {1, {0.0F, 0.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F, 0.0F}},
      {2, {-0.577350269F, 0.577350269F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F, 0.0F}},
      {3, {-0.774596669F, 0.0F, 0.774596669F, 0.0F}, {0.555555556F, 0.888888889F, 0.555555556F, 0.0F}},
      {4,
       {-0.861136312F, -0.339981044F, 0.339981044F, 0.861136312F},
       {0.347854845F, 0.652145155F, 0.652145155F, 0.347854845F}}};
  if (half_m < kOneNodeM) return kRules[0];
  if (half_m < kTwoNodesM) return kRules[1];
  return kRules[half_m < kThreeNodesM ? 2 : 3];
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

}  // namespace s4tp::sadrf
