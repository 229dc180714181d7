#include "algo/sadrf/box_integral.hpp"

#include "algo/core/inline.hpp"
#include "algo/sadrf/path_coordinates.hpp"

namespace s4tp::sadrf {
namespace {

constexpr float kNothing = 1e-9F;  // of an integral
constexpr float kAcross = 0.1F;    // of the line: one that hardly leads across the field counts for nothing

/// A straight piece of a line through the field: s = s_m + ds t, e = e_m + de t, |t| <= half_m, de > 0.
struct Line {
  float s_m;
  float e_m;
  float ds;
  float de;
  float half_m;
};

float sigma_at(const Field& field, float s_m, float e_m) {
  return (e_m > 0.0F ? field.widening_left : field.widening_right) * s_m + field.base_width_m;
}

/// Integral of e exp(-e^2 / (2 sigma^2)) from 0 to e; positive on both sides.
float first_moment(float e_m, float sigma_m) {
  const float variance = square(sigma_m);
  return variance * (1.0F - exp(-0.5F * square(e_m) / variance));
}

float over_line(const Field& field, const Line& line) {
  constexpr float kSkewed = 0.15F;  // m of s along half the line; below, s counts as constant on it
  const bool skewed = abs(line.ds) * line.half_m > kSkewed;
  float right_m = -line.half_m;
  float left_m = line.half_m;
  float s_m = line.s_m;
  if (skewed) {
    // Only the part between the car and the look-ahead distance.
    const float at_car_m = -line.s_m / line.ds;
    const float at_end_m = (field.look_ahead_m - line.s_m) / line.ds;
    right_m = max(right_m, min(at_car_m, at_end_m));
    left_m = min(left_m, max(at_car_m, at_end_m));
    if (left_m <= right_m) return 0.0F;
    s_m += line.ds * 0.5F * (right_m + left_m);
  }
  s_m = clamp(s_m, 0.0F, field.look_ahead_m);
  const float e_right_m = line.e_m + line.de * right_m;
  const float e_left_m = line.e_m + line.de * left_m;
  // Integral of exp(-e^2 / (2 sigma^2)) over e between the ends of the line, sigma taken at s_m.
  float right_sigma_m = sigma_at(field, s_m, e_right_m);
  float left_sigma_m = sigma_at(field, s_m, e_left_m);
  float integral = gauss_integral(e_left_m, left_sigma_m) - gauss_integral(e_right_m, right_sigma_m);
  if (integral <= kNothing) return 0.0F;
  if (skewed) {
    // The mass of the line lies about its centroid: a(s) and sigma(s) are right there to first order.
    const float moment = first_moment(e_left_m, left_sigma_m) - first_moment(e_right_m, right_sigma_m);
    const float t = clamp((moment / integral - line.e_m) / line.de, right_m, left_m);
    s_m = clamp(line.s_m + line.ds * t, 0.0F, field.look_ahead_m);
    right_sigma_m = sigma_at(field, s_m, e_right_m);
    left_sigma_m = sigma_at(field, s_m, e_left_m);
    integral = gauss_integral(e_left_m, left_sigma_m) - gauss_integral(e_right_m, right_sigma_m);
  }
  return field.steepness * square(field.look_ahead_m - s_m) * integral / line.de;
}

}  // namespace

float gauss_integral(float e_m, float sigma_m) {
  return 1.25331414F * sigma_m * erf(0.707106781F * e_m / sigma_m);
}

bool out_of_reach(const Field& field, Point box_centre, float box_radius_m) {
  const Point offset = box_centre - field.origin;
  const float y_m = cross(field.ahead, offset);
  if (abs(y_m) > field.lateral_reach_m + box_radius_m) return true;
  // Up to a quarter turn the field stays ahead of the rear axle, and never gets further than its look-ahead.
  if (abs(field.curvature_1pm) * field.look_ahead_m > 0.5F * kPi) return false;
  const float x_m = dot(field.ahead, offset);
  return x_m < -box_radius_m || x_m > field.look_ahead_m + field.lateral_reach_m + box_radius_m;
}

float field_over_box(const Field& field, const Box& box) {
  return field_over_box(field, box, direction(box.centre.heading_rad));
}

float field_over_box(const Field& field, const Box& box, Point axis) {
  const Point offset = position(box.centre) - field.origin;
  const PathCoordinates at =
      path_coordinates(field.curvature_1pm, dot(field.ahead, offset), cross(field.ahead, offset));
  const float radius_m = 0.5F * (box.length_m + box.width_m);
  if (at.s_m < -radius_m || at.s_m > field.look_ahead_m + radius_m) return 0.0F;
  const float widest_m = sigma_at(field, min(at.s_m + radius_m, field.look_ahead_m), at.e_m);
  if (abs(at.e_m) > kFieldReach * widest_m + radius_m) return 0.0F;

  // The box's heading relative to the path; the steps go along its side that is more along the path.
  const float axis_x = dot(field.ahead, axis);
  const float axis_y = cross(field.ahead, axis);
  float along = axis_x * at.tangent_x + axis_y * at.tangent_y;
  float left = axis_y * at.tangent_x - axis_x * at.tangent_y;
  float half_step_m = 0.5F * box.length_m;
  float half_line_m = 0.5F * box.width_m;
  if (abs(along) < abs(left)) {
    const float turned = along;
    along = left;
    left = -turned;
    half_step_m = 0.5F * box.width_m;
    half_line_m = 0.5F * box.length_m;
  }
  if (along < 0.0F) {
    along = -along;
    left = -left;
  }

  // Only the lines that cross the part between the car and the look-ahead distance.
  const float s_per_m = along / at.q;
  const float skew_m = abs(left) / at.q * half_line_m;
  const float low_m = max(-half_step_m, -(at.s_m + skew_m) / s_per_m);
  const float high_m = min(half_step_m, (field.look_ahead_m + skew_m - at.s_m) / s_per_m);
  if (high_m <= low_m) return 0.0F;
  const float middle_m = 0.5F * (low_m + high_m);
  const float half_m = 0.5F * (high_m - low_m);

  const float turn = field.curvature_1pm * s_per_m;  // of the tangent, per metre along the steps
  constexpr float kNode = 0.577350269F;              // 1 / sqrt(3)
  float sum = 0.0F;
  for (int side = -1; side <= 1; side += 2) {
    const float t = middle_m + half_m * kNode * static_cast<float>(side);
    Line line;
    line.s_m = at.s_m + t * (s_per_m + t * turn * left / at.q);
    line.e_m = at.e_m + t * (left - 0.5F * t * turn * along);
    line.ds = -(left - turn * along * t) / at.q;
    line.de = along + turn * left * t;
    line.half_m = half_line_m;
    if (line.de > kAcross) sum += over_line(field, line);
  }
  return half_m * sum;
}

}  // namespace s4tp::sadrf
