// The exact integral of a field over a box, and its gradient, on random drivers and boxes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/box_slices.hpp"
#include "tests/support/risk_scenes.hpp"

namespace s4tp::sadrf {
namespace {

using test::exact_over_box;
using test::FieldAndBox;
using test::random_field_and_box;

unsigned printed_seed() {
  const unsigned seed = 20261121U + static_cast<unsigned>(GTEST_FLAG_GET(random_seed));
  std::cout << "seed " << seed << " (--gtest_random_seed=N: N more)\n";
  return seed;
}

double at(std::vector<double> errors, double share) {
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
}

}  // namespace

// CORE-067: boxes of cars at any heading, mean density at least a thousandth of the highest: median within
// 0.1 %, p95 within 1 %; the two lines of the ranking level on the same boxes are printed beside it.
TEST(FieldSlices, AgreeWithTheExactIntegral) {
  std::mt19937 random(printed_seed());
  std::vector<double> slices;
  std::vector<double> lines;
  while (slices.size() < 600) {
    const FieldAndBox one = random_field_and_box(random, kPi, 0.0F);
    const double exact = exact_over_box(one.field(), one.box, 0.05);
    if (exact < 1e-3 * one.highest()) continue;
    slices.push_back(std::fabs(static_cast<double>(field_over_slices(one.field(), one.box)) - exact) / exact);
    lines.push_back(std::fabs(static_cast<double>(field_over_box(one.field(), one.box)) - exact) / exact);
  }
  std::cout << "slices: median " << at(slices, 0.5) << ", p95 " << at(slices, 0.95) << "; two lines: median "
            << at(lines, 0.5) << ", p95 " << at(lines, 0.95) << '\n';
  EXPECT_LE(at(slices, 0.5), 0.001);
  EXPECT_LE(at(slices, 0.95), 0.01);
}

// CORE-068: central differences of the exact integral by x, y, heading, speed and steering, with steps that
// move the field by some 2 cm at the box: errors against the derivative plus a twentieth of what a field
// falling by 1 / e within sigma would have.
TEST(FieldSlices, GradientAgreesWithDifferences) {
  std::mt19937 random(printed_seed());
  std::vector<double> errors;
  for (int n = 0; n < 150;) {
    const FieldAndBox one = random_field_and_box(random, kPi, 0.0F);
    const Field field = one.field();
    const double exact = exact_over_box(field, one.box, 0.1);
    if (exact < 1e-2 * one.highest()) continue;
    ++n;
    FieldGradient gradient;
    const FieldSlopes slopes = field_slopes(one.params, one.driver.speed_mps, field.curvature_1pm,
                                            one.driver.steering_rad, one.driver.wheelbase_m);
    int lines = 0;
    const float value = field_over_slices(field, one.box, slopes, gradient, lines);
    EXPECT_FLOAT_EQ(value, field_over_slices(field, one.box));
    const double far =
        1.0 + static_cast<double>(distance(position(one.box.centre), position(one.driver.rear_axle)));
    const double steps[] = {0.02, 0.02, 0.02 / far, 0.02, 0.02 * 2.0 * 2.9 / (far * far)};
    const float analytic[] = {gradient.x, gradient.y, gradient.heading, gradient.speed, gradient.steering};
    for (int k = 0; k < 5; ++k) {
      // |delta| has a kink at 0 that no difference may straddle.
      if (k == 4 && std::fabs(static_cast<double>(one.driver.steering_rad)) < 2.0 * steps[k]) continue;
      double values[2];
      for (int side = 0; side < 2; ++side) {
        FieldAndBox moved = one;
        const float step = static_cast<float>(side == 0 ? -steps[k] : steps[k]);
        float* const numbers[] = {&moved.driver.rear_axle.x_m, &moved.driver.rear_axle.y_m,
                                  &moved.driver.rear_axle.heading_rad, &moved.driver.speed_mps,
                                  &moved.driver.steering_rad};
        *numbers[k] += step;
        values[side] = exact_over_box(moved.field(), moved.box, 0.02);
      }
      const double difference = (values[1] - values[0]) / (2.0 * steps[k]);
      const double scale = std::fabs(difference) + 0.05 * exact * 0.02 / steps[k];
      errors.push_back(std::fabs(static_cast<double>(analytic[k]) - difference) / scale);
    }
  }
  std::cout << "gradient: median " << at(errors, 0.5) << ", p95 " << at(errors, 0.95) << ", worst "
            << at(errors, 1.0) << '\n';
  EXPECT_LE(at(errors, 0.5), 0.002);
  EXPECT_LE(at(errors, 0.95), 0.04);
}

}  // namespace s4tp::sadrf
