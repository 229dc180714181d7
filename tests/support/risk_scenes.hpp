#pragma once
// Random drivers and boxes for tests of the risk field, and the field once more, in double and from the
// circle.
#include <algorithm>
#include <cmath>
#include <random>

#include "algo/core/math.hpp"
#include "algo/sadrf/field.hpp"

namespace s4tp::test {

/// A driver in a turn it can hold, and the box of a car somewhere along its path.
struct FieldAndBox {
  sadrf::FieldParams params;
  sadrf::DriverState driver;
  Box box;

  [[nodiscard]] sadrf::Field field() const { return sadrf::prepare_field(params, driver); }
  /// What a box as dense as the field's highest point would have.
  [[nodiscard]] double highest() const {
    const sadrf::Field of = field();
    return static_cast<double>(of.steepness * of.look_ahead_m * of.look_ahead_m * box.length_m * box.width_m);
  }
};

inline FieldAndBox random_field_and_box(std::mt19937& random, float heading_spread_rad,
                                        float heading_offset_rad) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  FieldAndBox one;
  const float speed = 3.0F + 13.0F * unit(random);
  const float sharpest = std::min(0.5F, std::atan(2.9F * 3.0F / (speed * speed)));
  one.params = unit(random) < 0.5F ? sadrf::paper_preset(1.8F) : sadrf::kolekar2020_preset(1.8F);
  one.params.look_ahead_s = 1.0F + 2.5F * unit(random);
  const Pose axle = {30.0F * unit(random), -20.0F * unit(random), 6.0F * unit(random) - 3.0F};
  one.driver = {axle, speed, (2.0F * unit(random) - 1.0F) * sharpest, 2.9F};
  const sadrf::Field field = one.field();
  const float s = field.look_ahead_m * unit(random);
  const float e = 8.0F * (unit(random) - 0.5F);
  const float kappa = field.curvature_1pm;
  const float turned = kappa * s;
  const float x = std::fabs(kappa) < 1e-4F ? s : std::sin(turned) / kappa;
  const float y = std::fabs(kappa) < 1e-4F ? 0.0F : (1.0F - std::cos(turned)) / kappa;
  const Point at = offset_point(axle, x - e * std::sin(turned), y + e * std::cos(turned));
  const float heading =
      axle.heading_rad + turned + heading_offset_rad + heading_spread_rad * (2.0F * unit(random) - 1.0F);
  one.box = {{at.x_m, at.y_m, wrap_angle(heading)}, 4.0F + 1.5F * unit(random), 1.7F + 0.4F * unit(random)};
  return one;
}

/// The field in double, by method.md's formulas; the support is the half-plane x >= 0 of the driver's frame.
inline double density(const sadrf::Field& field, double x, double y) {
  const double kappa = static_cast<double>(field.curvature_1pm);
  const double u = 1.0 - kappa * y;
  const double w = kappa * x;
  const double e = (2.0 * y - kappa * (x * x + y * y)) / (1.0 + std::hypot(u, w));
  const double s = std::fabs(kappa) < 1e-9 ? x : std::atan2(std::fabs(kappa) * x, u) / std::fabs(kappa);
  const double left = static_cast<double>(field.look_ahead_m) - s;
  if (x < 0.0 || left < 0.0) return 0.0;
  const double widening = static_cast<double>(e > 0.0 ? field.widening_left : field.widening_right);
  const double sigma = widening * s + static_cast<double>(field.base_width_m);
  return static_cast<double>(field.steepness) * left * left * std::exp(-e * e / (2.0 * sigma * sigma));
}

/// Integral over a box: midpoints of cells of `cell_m`, on lines across it that end where the field begins.
inline double exact_over_box(const sadrf::Field& field, const Box& box, double cell_m) {
  const double length = static_cast<double>(box.length_m);
  const double width = static_cast<double>(box.width_m);
  const int lines = static_cast<int>(std::ceil(length / cell_m));
  const int points = static_cast<int>(std::ceil(width / cell_m));
  const double turned =
      std::atan2(static_cast<double>(field.ahead.y_m), static_cast<double>(field.ahead.x_m));
  const double cosine = std::cos(turned);
  const double sine = std::sin(turned);
  const double heading = static_cast<double>(box.centre.heading_rad) - turned;
  const double dx = static_cast<double>(box.centre.x_m) - static_cast<double>(field.origin.x_m);
  const double dy = static_cast<double>(box.centre.y_m) - static_cast<double>(field.origin.y_m);
  double sum = 0.0;
  for (int i = 0; i < lines; ++i) {
    const double along = ((i + 0.5) / lines - 0.5) * length;
    const double x = cosine * dx + sine * dy + along * std::cos(heading);
    const double y = cosine * dy - sine * dx + along * std::sin(heading);
    const double x_per_left = -std::sin(heading);
    double low = -0.5 * width;
    double high = 0.5 * width;
    if (std::fabs(x_per_left) < 1e-12) {
      if (x < 0.0) continue;
    } else if (x_per_left > 0.0) {
      low = std::max(low, -x / x_per_left);
    } else {
      high = std::min(high, -x / x_per_left);
    }
    if (high <= low) continue;
    for (int j = 0; j < points; ++j) {
      const double left = low + (j + 0.5) / points * (high - low);
      sum += density(field, x + left * x_per_left, y + left * std::cos(heading)) * (high - low) / points;
    }
  }
  return sum * length / lines;
}

}  // namespace s4tp::test
