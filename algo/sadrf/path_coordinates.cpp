#include "algo/sadrf/path_coordinates.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::sadrf {

PathCoordinates path_coordinates(float curvature_1pm, float x_m, float y_m) {
  constexpr float kAtCentre = 1e-6F;  // q there: the centre of the turn has no foot
  const float u = 1.0F - curvature_1pm * y_m;
  const float w = curvature_1pm * x_m;
  const float q = max(sqrt(u * u + w * w), kAtCentre);
  const float e_m = (2.0F * y_m - curvature_1pm * (x_m * x_m + y_m * y_m)) / (1.0F + q);
  float s_m = 0.0F;
  if (u > 0.0F && abs(w) <= 0.25F * u) {
    // atan(z) / z as a series: the first neglected term is z^10 / 11, below 9e-8 here.
    const float ratio = 1.0F / u;
    const float z2 = square(w * ratio);
    const float series = 1.0F + z2 * (-0.333333333F + z2 * (0.2F + z2 * (-0.142857143F + z2 * 0.111111111F)));
    s_m = x_m * ratio * series;
  } else {
    const float magnitude = abs(curvature_1pm);
    s_m = atan2(magnitude * x_m, u) / magnitude;
  }
  return {s_m, e_m, q, u / q, w / q};
}

}  // namespace s4tp::sadrf
