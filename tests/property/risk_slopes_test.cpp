// Slopes of the risk along a trajectory against differences of the risk itself, on random scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include "algo/sadrf/box_slices.hpp"
#include "algo/sadrf/risk.hpp"
#include "tests/support/risk_worlds.hpp"

namespace s4tp::sadrf {
namespace {

using test::random_world;
using test::RiskWorld;

SmoothRisk risk_at(const RiskWorld& world, int step) {
  SmoothRisk risks[kHorizonSteps];
  WorkMeter unbounded{kUnboundedWork};
  smooth_risk(world.scene, world.prediction, world.others, world.trajectory, world.parameters, step,
              kHorizonSteps, risks, unbounded);
  return risks[step];
}

/// The step's share of risk_integral over dt, without the road.
double exact_at(const RiskWorld& world, int step) {
  DrivableArea nowhere;
  RiskProfile profile;
  exact_risk(world.scene, nowhere, world.prediction, world.others, world.trajectory, world.parameters,
             profile);
  const Parameters& parameters = world.parameters;
  return static_cast<double>(profile.obstacle[step] + parameters.risk.weight_social * profile.social[step] +
                             parameters.scoring.risk_excess *
                                 std::max(profile.obstacle[step] - parameters.risk.threshold, 0.0F));
}

double at(std::vector<double> errors, double share) {
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
}

}  // namespace

// CORE-069 CORE-070: central differences by x, y, heading, speed and steering of single points, wherever the
// risk there is at least 1,000; errors against the derivative plus what a field falling by 1 / e in 2 m would
// have. What is made smooth stays near the exact risk.
TEST(RiskSlopes, AgreeWithDifferences) {
  const unsigned first = 20261121U + static_cast<unsigned>(GTEST_FLAG_GET(random_seed));
  std::cout << "seeds from " << first << " (--gtest_random_seed=N: N more)\n";
  std::vector<double> errors;
  std::vector<double> smoothed;
  for (unsigned seed = first; errors.size() < 600; ++seed) {
    const auto world = random_world(seed);
    for (satp::AgentPrediction& of : world->prediction.agents) {
      for (satp::Mode& mode : of.modes)
        mode = world->others.agents[of.agent];  // one place each: nothing is covered
      of.modes.truncate(1);
    }
    world->parameters.risk.threshold = 5000.0F;
    const int step = static_cast<int>(seed % 30U);
    const SmoothRisk risk = risk_at(*world, step);
    const double here = static_cast<double>(risk.value);
    if (here < 1000.0) continue;
    smoothed.push_back(std::fabs(here - exact_at(*world, step)) / here);
    const FieldGradient& slope = risk.slope;
    const double analytic[] = {static_cast<double>(slope.x), static_cast<double>(slope.y),
                               static_cast<double>(slope.heading), static_cast<double>(slope.speed),
                               static_cast<double>(slope.steering)};
    const double steps[] = {0.02, 0.02, 0.002, 0.05, 0.0005};
    const double kappa = static_cast<double>(world->trajectory.points[step + 1].curvature_1pm);
    for (int k = 0; k < 5; ++k) {
      const double steering = std::atan(2.9 * kappa);
      double values[2];
      for (int side = 0; side < 2; ++side) {
        RiskWorld moved = *world;
        TrajectoryPoint& point = moved.trajectory.points[step + 1];
        const float by = static_cast<float>(side == 0 ? -steps[k] : steps[k]);
        if (k == 0) point.rear_axle.x_m += by;
        if (k == 1) point.rear_axle.y_m += by;
        if (k == 2) point.rear_axle.heading_rad += by;
        if (k == 3) point.speed_mps = std::max(point.speed_mps + by, 0.0F);
        if (k == 4)
          point.curvature_1pm =
              static_cast<float>(std::tan(steering + (side == 0 ? -steps[k] : steps[k])) / 2.9);
        values[side] = static_cast<double>(risk_at(moved, step).value);
      }
      const double difference = (values[1] - values[0]) / (2.0 * steps[k]);
      const double lever[] = {2.0, 2.0, 0.1, 2.0, 0.1};  // a change that matters
      errors.push_back(std::fabs(analytic[k] - difference) / (std::fabs(difference) + here / lever[k]));
    }
  }
  std::cout << "slopes: median " << at(errors, 0.5) << ", p95 " << at(errors, 0.95) << '\n';
  std::cout << "smooth against exact: median " << at(smoothed, 0.5) << ", p95 " << at(smoothed, 0.95) << '\n';
  EXPECT_LE(at(smoothed, 0.5), 0.12);
  EXPECT_LE(at(errors, 0.5), 0.01);
  EXPECT_LE(at(errors, 0.95), 0.05);
}

// A box of 4 x 2 m about our own axle, straight, d = 20 m, sigma 0.5 m throughout: 2 m of it lie ahead, the
// integral across is 0.5 sqrt(2 pi) erf(sqrt(2)) = 1.1963. A shift ahead gains nothing at the car, where the
// field begins with a step, and loses a(2) = 0.0064 * 18^2 = 2.0736 at the far end: -2.4807. Without the term
// of the line s = 0 it would be (a(0) - a(2)) * 1.1963 = +0.582.
TEST(RiskSlopes, TheStepAtTheCarIsCounted) {
  FieldParams params = paper_preset(2.0F);
  params.widening = 0.0F;
  params.look_ahead_s = 2.0F;
  const Field field = prepare_field(params, DriverState{{0.0F, 0.0F, 0.0F}, 10.0F, 0.0F, 2.9F});
  const FieldSlopes slopes = field_slopes(params, 10.0F, 0.0F, 0.0F, 2.9F);
  FieldGradient gradient;
  int lines = 0;
  const float value = field_over_slices(field, {{0.0F, 0.0F, 0.0F}, 4.0F, 2.0F}, slopes, gradient, lines);
  EXPECT_NEAR(gradient.x, -2.4807F, 1e-3F);
  EXPECT_NEAR(gradient.y, 0.0F, 1e-5F);
  // d of 20 m grows by 2 m per m/s: 2 * integral of 2 p (20 - s) over 2 m = 2 * 0.0064 * (20^2 - 18^2)
  // * 1.1963.
  EXPECT_NEAR(gradient.speed, 2.0F * 0.0064F * 76.0F * 1.1963F, 2e-3F);
  EXPECT_NEAR(value, 0.0064F * (8000.0F - 5832.0F) / 3.0F * 1.1963F, 1e-2F);
}

// |delta| at 0: the slope by steering lies between those just to the right and just to the left of it.
TEST(RiskSlopes, SteeringAtZeroIsInTheSubgradient) {
  const FieldParams params = paper_preset(2.0F);
  const Box box = {{25.0F, 1.5F, 0.2F}, 4.5F, 1.8F};
  float by_steering[3];
  for (int i = 0; i < 3; ++i) {
    const float steering = 1e-5F * static_cast<float>(i - 1);
    const DriverState driver = {{0.0F, 0.0F, 0.0F}, 12.0F, steering, 2.9F};
    const Field field = prepare_field(params, driver);
    FieldGradient gradient;
    int lines = 0;
    (void)field_over_slices(field, box, field_slopes(params, 12.0F, field.curvature_1pm, steering, 2.9F),
                            gradient, lines);
    by_steering[i] = gradient.steering;
  }
  EXPECT_LT(std::min(by_steering[0], by_steering[2]), by_steering[1]);
  EXPECT_GT(std::max(by_steering[0], by_steering[2]), by_steering[1]);
}

}  // namespace s4tp::sadrf
