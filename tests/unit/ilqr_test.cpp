// The optimizer's parts: model, derivatives, box step, one pass.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/ilqr_backward.hpp"
#include "tests/support/refinement_scenes.hpp"

namespace s4tp::trajectory {
namespace {

using Random = std::mt19937;

float draw(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

MotionState random_state(Random& random) {
  return {draw(random, -30.0F, 30.0F), draw(random, -30.0F, 30.0F), draw(random, -3.0F, 3.0F),
          draw(random, 0.0F, 15.0F),   draw(random, -4.0F, 3.0F),   draw(random, -0.15F, 0.15F)};
}

/// The model again, in double and in one piece.
struct Double6 {
  double x, y, psi, v, a, kappa;
};
Double6 step_in_double(const double (&s)[6], const double (&u)[2]) {
  const double dt = 0.1;
  const double w = 0.1;
  const double free = s[3] + dt * s[4] + 0.5 * dt * dt * u[0];
  const double t = free / w;
  const double v = free >= w ? free : (free <= 0 ? 0 : w * t * t * (2 - t));
  const double way = 0.5 * dt * (s[3] + v);
  const double turn = (s[5] + 0.5 * dt * u[1]) * way;
  return {s[0] + way * std::cos(s[2] + 0.5 * turn),
          s[1] + way * std::sin(s[2] + 0.5 * turn),
          s[2] + turn,
          v,
          s[4] + dt * u[0],
          s[5] + dt * u[1]};
}

// With constant acceleration and curvature rate the model is the planner's bicycle: 8 m/s, 1 m/s^2, 0.02 / m
// s.
TEST(IlqrModel, IsTheBicycle) {
  const MotionState state = {1.0F, 2.0F, 0.5F, 8.0F, 1.0F, 0.05F};
  const MotionState next = motion_step(state, {0.0F, 0.02F});
  TrajectoryPoint point;
  point.rear_axle = {1.0F, 2.0F, 0.5F};
  point.speed_mps = 8.0F;
  point.curvature_1pm = 0.05F;
  const TrajectoryPoint there = bicycle_step(point, 1.0F, 0.02F, kStepS);
  EXPECT_NEAR(next.x_m, there.rear_axle.x_m, 1e-5F);
  EXPECT_NEAR(next.y_m, there.rear_axle.y_m, 1e-5F);
  EXPECT_NEAR(next.heading_rad, there.rear_axle.heading_rad, 1e-6F);
  EXPECT_EQ(next.speed_mps, there.speed_mps);
  EXPECT_EQ(next.curvature_1pm, there.curvature_1pm);
}

// At rest without drive nothing changes, to the bit, and braking never makes the speed negative.
TEST(IlqrModel, RestIsAFixedPoint) {
  MotionState rest = {3.0F, -1.0F, 0.7F, 0.0F, 0.0F, 0.03F};
  const MotionState next = motion_step(rest, {});
  EXPECT_EQ(std::memcmp(&rest, &next, sizeof(rest)), 0);
  MotionState state = {0.0F, 0.0F, 0.0F, 0.35F, -2.0F, 0.0F};
  for (int i = 0; i < 10; ++i) {
    state = motion_step(state, {});
    EXPECT_GE(state.speed_mps, 0.0F);
  }
  EXPECT_EQ(state.speed_mps, 0.0F);
}

// Every entry of A and B against central differences of the model in double, also within the smooth clamp.
TEST(IlqrModel, JacobianAgreesWithDifferences) {
  Random random(1);
  for (int n = 0; n < 500; ++n) {
    MotionState state = random_state(random);
    if (n % 5 == 0) {
      state.speed_mps = draw(random, 0.01F, 0.09F);
      state.acceleration_mps2 = 0.0F;
    }
    const MotionInput input = {n % 5 == 0 ? 0.0F : draw(random, -10.0F, 10.0F), draw(random, -0.2F, 0.2F)};
    if (state.speed_mps + 0.1F * state.acceleration_mps2 + 0.005F * input.jerk_mps3 < 0.001F) continue;
    const MotionJacobian j = motion_jacobian(state, input);
    const double s[6] = {
        state.x_m,          state.y_m, state.heading_rad, state.speed_mps, state.acceleration_mps2,
        state.curvature_1pm};
    const double u[2] = {input.jerk_mps3, input.curvature_rate_1pms};
    const double dt = 0.1;
    const double a[6][6] = {
        {1, 0, j.turn[0], j.way_by_speed * j.way[0], j.way_by_acceleration * j.way[0], j.bend[0]},
        {0, 1, j.turn[1], j.way_by_speed * j.way[1], j.way_by_acceleration * j.way[1], j.bend[1]},
        {0, 0, 1, j.way_by_speed * j.way[2], j.way_by_acceleration * j.way[2], j.bend[2]},
        {0, 0, 0, j.speed_gain, j.speed_gain * dt, 0},
        {0, 0, 0, 0, 1, 0},
        {0, 0, 0, 0, 0, 1}};
    for (int column = 0; column < 8; ++column) {
      double high_s[6], low_s[6], high_u[2], low_u[2];
      std::memcpy(high_s, s, sizeof(s));
      std::memcpy(low_s, s, sizeof(s));
      std::memcpy(high_u, u, sizeof(u));
      std::memcpy(low_u, u, sizeof(u));
      const double h = 1e-6;
      (column < 6 ? high_s[column] : high_u[column - 6]) += h;
      (column < 6 ? low_s[column] : low_u[column - 6]) -= h;
      const Double6 high = step_in_double(high_s, high_u);
      const Double6 low = step_in_double(low_s, low_u);
      const double difference[6] = {high.x - low.x, high.y - low.y, high.psi - low.psi,
                                    high.v - low.v, high.a - low.a, high.kappa - low.kappa};
      const int source = column == 6 ? 4 : 5;  // B_j = dt/2 (A_a + e_a), B_c = dt/2 (A_kappa + e_kappa)
      for (int row = 0; row < 6; ++row) {
        const double entry =
            column < 6 ? a[row][column] : dt / 2 * (a[row][source] + (row == source ? 1.0 : 0.0));
        EXPECT_NEAR(entry, difference[row] / (2 * h), 2e-5 * (1 + std::abs(entry)))
            << "row " << row << " column " << column << " draw " << n;
      }
    }
  }
}

float& entry(MotionState& state, int index) {
  float* const entries[] = {
      &state.x_m,          &state.y_m, &state.heading_rad, &state.speed_mps, &state.acceleration_mps2,
      &state.curvature_1pm};
  return *entries[index];
}

StateCost cost_at(const RefinementProblem& problem, const BoundState& bounds, int index,
                  const MotionState& state) {
  StateCost cost = {StateVector::Zero(), StateMatrix::Zero()};
  add_step_cost(problem, bounds, index, state, cost);
  return cost;
}

// The gradient of cost and bounds against central differences, at motions displaced by up to 1.5 m, 0.2 rad
// and 2 m/s, where many a bound is broken. Differences of floats are good to a percent of the steepest entry.
TEST(IlqrCost, GradientAgreesWithDifferences) {
  int compared = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    const auto scene = test::random_refinement(seed);
    if (scene == nullptr) continue;
    Random random(seed);
    BoundState bounds;
    bounds.penalty = 2.0F;
    for (BoundMultipliers& multipliers : bounds.multipliers) multipliers.across = draw(random, -3.0F, 3.0F);
    const int index = static_cast<int>(random() % static_cast<unsigned>(kHorizonSteps));
    MotionState state = scene->start.states[index + 1];
    state.x_m += draw(random, -1.5F, 1.5F);
    state.y_m += draw(random, -1.5F, 1.5F);
    state.heading_rad += draw(random, -0.2F, 0.2F);
    state.speed_mps = std::abs(state.speed_mps + draw(random, -2.0F, 2.0F));
    state.curvature_1pm += draw(random, -0.05F, 0.05F);
    const MotionInput input = {draw(random, -5.0F, 5.0F), draw(random, -0.1F, 0.1F)};
    const StateCost cost = cost_at(scene->problem, bounds, index, state);
    const float h[6] = {2e-3F, 2e-3F, 1e-3F, 2e-3F, 1e-2F, 2e-4F};
    for (int i = 0; i < 6; ++i) {
      const auto merit_at = [&](float shift) {
        MotionState moved = state;
        entry(moved, i) += shift;
        return static_cast<double>(step_merit(scene->problem, bounds, index, input, moved));
      };
      const double difference = (merit_at(h[i]) - merit_at(-h[i])) / (2.0 * h[i]);
      const double noise = 1e-6 * merit_at(0.0F) / h[i];
      EXPECT_NEAR(cost.gradient[i], difference, 0.02 * std::abs(difference) + 5.0 * noise + 0.03)
          << "entry " << i << " seed " << seed;
      ++compared;
    }
    EXPECT_NEAR(input_cost(scene->problem, index, input).gradient[kJerk],
                scene->problem.weights.jerk * input.jerk_mps3, 1e-6F);
  }
  EXPECT_GT(compared, 300);
}

// On a straight line with nobody near, the cost is a sum of squares of linear residuals but for the lateral
// acceleration: at rest in curvature its Hessian is exact. Second differences of step_merit show every entry.
TEST(IlqrCost, HessianIsExactWhereResidualsAreLinear) {
  RefinementProblem problem;
  problem.weights = {0.1F, 0.2F, 0.0F, 0.0F, 1.0F, 5.0F, 0.3F, 5.0F, 2.0F, 10.0F, 2.0F};
  problem.acceleration_low_mps2 = -8.0F;
  problem.acceleration_high_mps2 = 3.5F;
  problem.curvature_bound_1pm = 0.2F;
  problem.lateral_bound_mps2 = 4.0F;
  RefinementStep& step = problem.steps[4];
  step.reference = {10.0F, 3.0F, 0.6F, 5.0F, 0.0F, 0.0F};
  step.along_x = std::cos(0.6F);
  step.along_y = std::sin(0.6F);
  step.speed_cap_mps = 20.0F;
  BoundState bounds;
  bounds.penalty = 0.5F;
  const MotionState state = {10.5F, 5.0F, 0.7F, 5.5F, 1.0F, 0.0F};  // across the bound of 1 m
  const StateCost cost = cost_at(problem, bounds, 4, state);
  const float h = 0.05F;
  const auto merit_at = [&](int i, float di, int j, float dj) {
    MotionState moved = state;
    entry(moved, i) += di;
    entry(moved, j) += dj;
    return static_cast<double>(step_merit(problem, bounds, 4, {}, moved));
  };
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const double second =
          (merit_at(i, h, j, h) - merit_at(i, h, j, -h) - merit_at(i, -h, j, h) + merit_at(i, -h, j, -h)) /
          (4.0 * h * h);
      EXPECT_NEAR(cost.hessian(i, j), second, 0.02 * std::abs(second) + 0.01) << i << ' ' << j;
    }
  }
}

// 1/2 (2 u^2 + 2 w^2) - 4 u - w has its least at (2, 0.5); with u <= 1 it moves to (1, 0.5), and there w
// alone is free.
TEST(IlqrBoxStep, StopsAtTheBound) {
  const BoxStep step = box_step(2.0F * InputMatrix::Identity(), {-4.0F, -1.0F}, {-1.0F, -1.0F}, {1.0F, 1.0F});
  EXPECT_FLOAT_EQ(step.u[0], 1.0F);
  EXPECT_FLOAT_EQ(step.u[1], 0.5F);
  EXPECT_FALSE(step.free[0]);
  EXPECT_TRUE(step.free[1]);
}

// Against a grid of 101 x 101 points over the box: none is better by more than rounding.
TEST(IlqrBoxStep, IsTheLeast) {
  Random random(3);
  for (int n = 0; n < 300; ++n) {
    const float a = draw(random, 0.1F, 3.0F);
    const float b = draw(random, -1.0F, 1.0F);
    const float c = draw(random, 0.1F, 3.0F);
    InputMatrix h;
    h << a * a, a * b, a * b, b * b + c * c;  // Cholesky: positive definite
    const InputVector g = {draw(random, -5.0F, 5.0F), draw(random, -5.0F, 5.0F)};
    const InputVector low = {draw(random, -2.0F, 0.0F), draw(random, -2.0F, 0.0F)};
    const InputVector high = {draw(random, 0.0F, 2.0F), draw(random, 0.0F, 2.0F)};
    const auto value = [&](float u, float w) {
      return 0.5F * (h(0, 0) * u * u + h(1, 1) * w * w) + h(0, 1) * u * w + g[0] * u + g[1] * w;
    };
    const BoxStep step = box_step(h, g, low, high);
    const float least = value(step.u[0], step.u[1]);
    for (int i = 0; i <= 100; ++i) {
      for (int k = 0; k <= 100; ++k) {
        const float u = low[0] + 0.01F * static_cast<float>(i) * (high[0] - low[0]);
        const float w = low[1] + 0.01F * static_cast<float>(k) * (high[1] - low[1]);
        ASSERT_GE(value(u, w), least - 1e-4F * (1.0F + std::abs(least))) << n;
      }
    }
  }
}

// A straight candidate at 10 m/s whose acceleration jumps between 0 and 1 m/s^2: one whole correction of a
// problem that is all but linear-quadratic gives the decrease the model promises, to 5 %.
TEST(IlqrPass, KeepsItsPromise) {
  RefinementProblem problem;
  problem.weights = {0.003F, 0.1F, 0.0F, 0.0F, 0.1F, 0.3F, 0.0F, 0.3F, 0.1F, 0.0F, 0.0F};
  problem.acceleration_low_mps2 = -8.0F;
  problem.acceleration_high_mps2 = 3.5F;
  problem.curvature_bound_1pm = 0.2F;
  problem.lateral_bound_mps2 = 4.0F;
  Motion motion;
  motion.states[0].speed_mps = 10.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    motion.inputs[i].jerk_mps3 = i % 2 == 0 ? 10.0F : -10.0F;
    motion.states[i + 1] = motion_step(motion.states[i], motion.inputs[i]);
    problem.steps[i].reference = motion.states[i + 1];
    problem.steps[i].speed_cap_mps = 100.0F;
    problem.steps[i].curvature_rate_weight = 0.1F;
    problem.steps[i].input_bound = {100.0F, 1.0F};
  }
  BoundState bounds;
  bounds.penalty = 1.0F;
  InputCorrection corrections[kHorizonSteps];
  const float promised = backward_pass(problem, bounds, motion, 0.0F, corrections);
  Ilqr ilqr;
  const IlqrResult result = ilqr.solve(problem, 1, motion);
  EXPECT_GT(promised, 1.0F);
  EXPECT_NEAR(result.cost_before - result.cost_after, promised, 0.05F * promised);
}

}  // namespace
}  // namespace s4tp::trajectory
