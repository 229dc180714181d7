#include "algo/sadrf/box_slices.hpp"

#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/slices.hpp"

namespace s4tp::sadrf {
namespace {

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

}  // namespace

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

}  // namespace s4tp::sadrf
