#include "algo/sadrf/field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "algo/core/math.hpp"
#include "algo/sadrf/box_integral.hpp"
#include "algo/sadrf/others_motion.hpp"
#include "tests/support/risk_scenes.hpp"

namespace s4tp::sadrf {
namespace {

const FieldParams kPaper = paper_preset(2.0F);

DriverState driving(float speed_mps, float steering_rad) {
  return {{0.0F, 0.0F, 0.0F}, speed_mps, steering_rad, 2.9F};
}

DriverState driving_straight(float speed_mps) {
  return driving(speed_mps, 0.0F);
}

/// The field by its definition with a circle, in double, for paths that are clearly curved: distance and
/// angle about the centre of the turn.
double by_the_circle(const FieldParams& params, const DriverState& driver, double x, double y) {
  const double kappa = std::tan(static_cast<double>(driver.steering_rad)) / driver.wheelbase_m;
  const double radius = 1.0 / kappa;
  const double side = kappa > 0.0 ? 1.0 : -1.0;
  const double e = side * (std::fabs(radius) - std::hypot(x, y - radius));
  const double angle = std::atan2(x, side * (radius - y));
  const double s = std::fabs(radius) * angle;
  const double look_ahead = std::max(1.0, static_cast<double>(driver.speed_mps) * params.look_ahead_s);
  if (s < 0.0 || s > look_ahead) return 0.0;
  const double k = kappa * e > 0.0 ? params.widening_inner : params.widening_outer;
  const double sigma =
      (params.widening + k * std::fabs(static_cast<double>(driver.steering_rad))) * s + params.base_width_m;
  return params.steepness * (s - look_ahead) * (s - look_ahead) * std::exp(-e * e / (2.0 * sigma * sigma));
}

/// Relative errors of the box integral on boxes that matter, sorted.
std::vector<double> box_errors(float heading_spread_rad, float heading_offset_rad) {
  std::mt19937 random(3);
  std::vector<double> errors;
  while (errors.size() < 400) {
    const test::FieldAndBox one = test::random_field_and_box(random, heading_spread_rad, heading_offset_rad);
    const double exact = test::exact_over_box(one.field(), one.box, 0.08);
    if (exact < 1e-3 * one.highest()) continue;
    errors.push_back(std::fabs(field_over_box(one.field(), one.box) - exact) / exact);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

}  // namespace

// Straight ahead at 10 m/s the look-ahead is 35 m, so at 35 m the field has just vanished: p (35 - 35)^2 = 0.
TEST(Field, VanishesAtTheLookAheadDistance) {
  EXPECT_EQ(field_at(kPaper, driving_straight(10.0F), {35.0F, 0.0F}), 0.0F);
  EXPECT_GT(field_at(kPaper, driving_straight(10.0F), {34.0F, 0.0F}), 0.0F);
  EXPECT_EQ(field_at(kPaper, driving_straight(10.0F), {36.0F, 0.0F}), 0.0F);
}

// At the car itself the field is p d^2 = 0.0064 * 35^2 = 7.84.
TEST(Field, IsHighestAtTheCar) {
  EXPECT_NEAR(field_at(kPaper, driving_straight(10.0F), {0.0F, 0.0F}), 7.84F, 1e-4F);
}

// Behind the car there is no risk, on any side and in any turn.
TEST(Field, VanishesBehindTheCar) {
  for (const float steering : {-0.3F, 0.0F, 0.3F}) {
    EXPECT_EQ(field_at(kPaper, driving(10.0F, steering), {-0.5F, 0.0F}), 0.0F);
    EXPECT_EQ(field_at(kPaper, driving(10.0F, steering), {-3.0F, 3.0F}), 0.0F);
    EXPECT_EQ(field_at(kPaper, driving(10.0F, steering), {-3.0F, -3.0F}), 0.0F);
  }
}

// Standing, the look-ahead is 1 m.
TEST(Field, ReachesOneMetreWhenStanding) {
  EXPECT_GT(field_at(kPaper, driving_straight(0.0F), {0.9F, 0.0F}), 0.0F);
  EXPECT_EQ(field_at(kPaper, driving_straight(0.0F), {1.1F, 0.0F}), 0.0F);
}

// One sigma to the side, at s = 20 m: sigma = 0.05 * 20 + 0.5 = 1.5 m, and the field falls to exp(-1/2).
TEST(Field, FallsByTheSquaredExponent) {
  const DriverState driver = driving_straight(10.0F);
  const float middle = field_at(kPaper, driver, {20.0F, 0.0F});
  EXPECT_NEAR(field_at(kPaper, driver, {20.0F, 1.5F}) / middle, std::exp(-0.5F), 1e-5F);
  EXPECT_NEAR(field_at(kPaper, driver, {20.0F, -3.0F}) / middle, std::exp(-2.0F), 1e-5F);
}

// method.md: sigma at 48.6 m straight is 2.93 m with the paper's preset and 0.55 m with that of 2020.
TEST(Field, PresetsDifferInWidth) {
  for (const auto& [params, sigma] :
       {std::pair{paper_preset(2.0F), 2.93F}, {kolekar2020_preset(2.0F), 0.5486F}}) {
    const DriverState driver = driving_straight(20.0F);
    const float middle = field_at(params, driver, {48.6F, 0.0F});
    EXPECT_NEAR(field_at(params, driver, {48.6F, sigma}) / middle, std::exp(-0.5F), 1e-3F);
  }
}

// In a left turn the path bends left; at the same distance from it the outside (right) is the wider one.
TEST(Field, IsWiderOutsideTheTurn) {
  const DriverState driver = driving(8.0F, 0.2F);
  const float radius = 2.9F / std::tan(0.2F);
  const float angle = 10.0F / radius;
  const auto point = [&](float e) {
    return Point{(radius - e) * std::sin(angle), radius - (radius - e) * std::cos(angle)};
  };
  EXPECT_GT(field_at(kPaper, driver, point(-2.0F)), field_at(kPaper, driver, point(2.0F)));
  EXPECT_GT(field_at(kPaper, driver, point(0.0F)), field_at(kPaper, driver, point(-2.0F)));
}

// The smooth form agrees with the definition by circle and centre, in all turns, up to half a circle.
TEST(Field, AgreesWithTheCircle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  for (int i = 0; i < 20000; ++i) {
    const DriverState driver = driving(10.0F * std::fabs(unit(random)), 0.55F * unit(random));
    if (std::fabs(driver.steering_rad) < 0.01F) continue;
    const Point point = {40.0F * unit(random), 40.0F * unit(random)};
    const double expected = by_the_circle(kPaper, driver, point.x_m, point.y_m);
    ASSERT_NEAR(field_at(kPaper, driver, point), expected, 2e-3 * expected + 2e-4)
        << driver.speed_mps << " " << driver.steering_rad << " " << point.x_m << " " << point.y_m;
  }
}

// A tight turn: 0.5 rad at 2.9 m is kappa = tan(0.5) / 2.9 = 0.18838, radius 5.3084 m; a quarter of a turn
// ends at (5.3084, 5.3084) after s = 5.3084 pi / 2 = 8.3384 m. At 5 m/s and 3.5 s: 0.0064 (17.5 - 8.3384)^2 =
// 0.5372; straight ahead of the car, 8.3384 m away, the path has long left: e = -(sqrt(8.3384^2 + 5.3084^2) -
// 5.3084) = -4.576.
TEST(Field, FollowsATightTurn) {
  const DriverState driver = driving(5.0F, 0.5F);
  EXPECT_NEAR(field_at(kPaper, driver, {5.3084F, 5.3084F}), 0.5372F, 1e-3F);
  const float angle = std::atan2(8.3384F, 5.3084F);
  const float s = 5.3084F * angle;
  const float sigma = (0.05F + 1.38F * 0.5F) * s + 0.5F;
  const float expected =
      0.0064F * (17.5F - s) * (17.5F - s) * std::exp(-0.5F * 4.576F * 4.576F / sigma / sigma);
  EXPECT_NEAR(field_at(kPaper, driver, {8.3384F, 0.0F}), expected, 1e-3F);
}

// The path of a car that looks further than half a circle ends there: atan(0.1 * 2.9) makes the radius 10 m,
// so that (0, 20) is the far side, s = 10 pi = 31.416 m. At 12 m/s (42 m): 0.0064 (42 - 31.416)^2 = 0.7169
// just before it; just behind it, where atan2 jumps from pi to -pi, nothing.
TEST(Field, WrapsBehindTheCar) {
  const DriverState driver = driving(12.0F, std::atan(0.29F));
  EXPECT_NEAR(field_at(kPaper, driver, {0.01F, 20.0F}), 0.7169F, 2e-3F);
  EXPECT_EQ(field_at(kPaper, driver, {-0.01F, 20.0F}), 0.0F);
  const DriverState mirrored = driving(12.0F, -std::atan(0.29F));
  EXPECT_NEAR(field_at(kPaper, mirrored, {0.01F, -20.0F}), 0.7169F, 2e-3F);
  EXPECT_EQ(field_at(kPaper, mirrored, {-0.01F, -20.0F}), 0.0F);
}

// Standing with the wheel turned, too, the field reaches 1 m: 0.0064 (1 - 0.5)^2 = 0.0016 half-way.
TEST(Field, StandingWithTheWheelTurned) {
  const float kappa = std::tan(0.4F) / 2.9F;
  const Point half_way = {std::sin(0.5F * kappa) / kappa, (1.0F - std::cos(0.5F * kappa)) / kappa};
  EXPECT_NEAR(field_at(kPaper, driving(0.0F, 0.4F), half_way), 0.0016F, 1e-6F);
}

// Steering through straight ahead changes the field smoothly: 1e-6 rad more changes no more than a
// thousandth.
TEST(Field, IsSmoothThroughStraightDriving) {
  for (float steering = -5e-6F; steering < 5e-6F; steering += 1e-6F) {
    const float here = field_at(kPaper, driving(14.0F, steering), {30.0F, 1.0F});
    const float there = field_at(kPaper, driving(14.0F, steering + 1e-6F), {30.0F, 1.0F});
    EXPECT_NEAR(there / here, 1.0F, 1e-3F);
  }
}

// t_la' = max(3.5 - t, 1): 3.5 at the start, 1.5 after 2 s, 1 after 3 s; the option `fixed` keeps 3.5.
TEST(Field, LookAheadShrinksToOneSecond) {
  EXPECT_FLOAT_EQ(look_ahead_at(3.5F, true, 0.0F), 3.5F);
  EXPECT_FLOAT_EQ(look_ahead_at(3.5F, true, 2.0F), 1.5F);
  EXPECT_FLOAT_EQ(look_ahead_at(3.5F, true, 3.0F), 1.0F);
  EXPECT_FLOAT_EQ(look_ahead_at(3.5F, false, 3.0F), 3.5F);
}

// CORE-060: cars along the path, to 10 degrees: median within 0.5 %, p95 within 5 %.
TEST(BoxIntegral, CarsAlongThePath) {
  const std::vector<double> errors = box_errors(0.17F, 0.0F);
  EXPECT_LE(errors[errors.size() / 2], 0.005);
  EXPECT_LE(errors[errors.size() * 95 / 100], 0.05);
}

// CORE-060: cars across the path, to 10 degrees: median within 1 %, p95 within 5 %.
TEST(BoxIntegral, CarsAcrossThePath) {
  const std::vector<double> errors = box_errors(0.17F, 0.5F * kPi);
  EXPECT_LE(errors[errors.size() / 2], 0.01);
  EXPECT_LE(errors[errors.size() * 95 / 100], 0.05);
}

// CORE-060: any heading, cars beside our own axle among them: median within 2 %, p95 within 20 %.
TEST(BoxIntegral, CarsAtAnyHeading) {
  const std::vector<double> errors = box_errors(kPi, 0.0F);
  EXPECT_LE(errors[errors.size() / 2], 0.02);
  EXPECT_LE(errors[errors.size() * 95 / 100], 0.2);
}

// What is told to be out of reach has no integral worth a ten-thousandth of the field's largest.
TEST(BoxIntegral, OutOfReachMeansNothing) {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> metres(-60.0F, 60.0F);
  int out = 0;
  for (int i = 0; i < 3000; ++i) {
    test::FieldAndBox one = test::random_field_and_box(random, kPi, 0.0F);
    const Field field = one.field();
    one.box.centre.x_m += metres(random);
    one.box.centre.y_m += metres(random);
    if (!out_of_reach(field, position(one.box.centre), 0.5F * (one.box.length_m + one.box.width_m))) continue;
    ++out;
    ASSERT_LE(test::exact_over_box(field, one.box, 0.25), 4e-4 * one.highest());
  }
  EXPECT_GT(out, 1000);
}

// A car turning at 10 m/s with 0.05 /m moves 3 m in 0.3 s and turns 0.15 rad; the sharpest curvature is 0.2
// /m.
TEST(OthersMotion, SpeedAndCurvatureFromTheFuture) {
  satp::Mode mode;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const float angle = 0.05F * static_cast<float>(i);
    mode.steps[i] = {20.0F * std::sin(angle), 20.0F * (1.0F - std::cos(angle)), wrap_angle(angle)};
  }
  for (const int step : {0, 2, 10, 29}) {
    EXPECT_NEAR(motion_at(mode, step).speed_mps, 10.0F, 0.02F);
    EXPECT_NEAR(motion_at(mode, step).curvature_1pm, 0.05F, 1e-4F);
  }
  for (int i = 0; i < kHorizonSteps; ++i)
    mode.steps[i] = {0.0F, 0.0F, wrap_angle(0.5F * static_cast<float>(i))};
  EXPECT_FLOAT_EQ(motion_at(mode, 10).curvature_1pm, 0.2F);
  EXPECT_FLOAT_EQ(motion_at(mode, 10).speed_mps, 0.0F);
}

// A 5 m car looking along +y: wheelbase 3 m, so that 0.1 /m is steered by atan(0.3), and rear axle 1.5 m
// behind the centre of its box: the very field of such a driver.
TEST(OthersMotion, FieldOfABox) {
  const Field field = field_of_other(kPaper, {10.0F, 5.0F, 0.5F * kPi}, {10.0F, 0.1F}, 5.0F);
  const DriverState driver = {{10.0F, 3.5F, 0.5F * kPi}, 10.0F, std::atan(0.3F), 3.0F};
  for (const Point point : {Point{9.0F, 12.0F}, Point{10.5F, 8.0F}, Point{3.0F, 14.0F}}) {
    const float expected = field_at(kPaper, driver, point);
    EXPECT_GT(expected, 0.01F);
    EXPECT_NEAR(field_at(field, point), expected, 1e-3F * expected);
  }
}

}  // namespace s4tp::sadrf
