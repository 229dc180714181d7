// The risk field in the optimizer: its slopes through the whole stage, and what refining in it promises.

#include "algo/trajectory/refinement_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <memory>
#include <vector>

#include "algo/sadrf/risk.hpp"
#include "algo/trajectory/ilqr_model.hpp"
#include "tests/support/refinement_scenes.hpp"

namespace s4tp::trajectory {
namespace {

unsigned first_seed() {
  const unsigned first = 20261122U + static_cast<unsigned>(GTEST_FLAG_GET(random_seed));
  std::cout << "seeds from " << first << " (--gtest_random_seed=N: N more)\n";
  return first;
}

double at(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

Point origin_of(const test::RefinementScene& scene) {
  return position(scene.trajectory.points[0].rear_axle);
}

/// The motion that the model makes of the inputs of `motion` + share * direction.
Motion driven(const Motion& motion, const MotionInput (&direction)[kHorizonSteps], float share) {
  Motion moved = motion;
  for (int i = 0; i < kHorizonSteps; ++i) {
    moved.inputs[i].jerk_mps3 += share * direction[i].jerk_mps3;
    moved.inputs[i].curvature_rate_1pms += share * direction[i].curvature_rate_1pms;
    moved.states[i + 1] = motion_step(moved.states[i], moved.inputs[i]);
  }
  return moved;
}

/// Slope of the problem's cost along `direction`, by the derivatives that the optimizer works with: from the
/// end backwards, what each state costs from there on.
double slope_along(const RefinementProblem& problem, const Motion& motion,
                   const MotionInput (&direction)[kHorizonSteps]) {
  double slope = 0.0;
  StateCost to_go = {StateVector::Zero(), StateMatrix::Zero()};
  for (int i = kHorizonSteps - 1; i >= 0; --i) {
    to_go.hessian.setZero();
    add_step_cost(problem, BoundState{}, i, motion.states[i + 1], to_go);
    const MotionJacobian j = motion_jacobian(motion.states[i], motion.inputs[i]);
    StateMatrix a = StateMatrix::Identity();
    a.block<2, 1>(kX, kPsi) = j.turn;
    a.block<3, 1>(kX, kV) = j.way_by_speed * j.way;
    a.block<3, 1>(kX, kA) = j.way_by_acceleration * j.way;
    a.block<3, 1>(kX, kKappa) = j.bend;
    a(kV, kV) = j.speed_gain;
    a(kV, kA) = kStepS * j.speed_gain;
    const StateVector before = a.transpose().lazyProduct(to_go.gradient);
    const InputVector by_input = 0.5F * kStepS * (before.tail<2>() + to_go.gradient.tail<2>()) +
                                 input_cost(problem, i, motion.inputs[i]).gradient;
    slope += static_cast<double>(by_input[kJerk] * direction[i].jerk_mps3 +
                                 by_input[kRate] * direction[i].curvature_rate_1pms);
    to_go.gradient = before;
  }
  return slope;
}

/// With all the work it takes. \return what the field costs along the motion
double evaluated(const test::RefinementScene& scene, const Motion& motion, FieldAlong& along) {
  FieldScratch scratch;
  WorkMeter unbounded{kUnboundedWork};
  return static_cast<double>(evaluate_field(scene.surroundings(), scene.problem, origin_of(scene), motion,
                                            scene.parameters, unbounded, scratch, along));
}

struct Driven {
  std::unique_ptr<test::RefinementScene> scene;
  Motion motion;  ///< an exact one of the model
  FieldAlong field;
  double field_cost = 0.0;  ///< what the field costs along it
};

/// \return null where nobody is in the field
std::unique_ptr<Driven> in_a_field(unsigned seed) {
  auto made = std::make_unique<Driven>();
  made->scene = test::random_refinement(seed);
  if (made->scene == nullptr) return nullptr;
  made->motion = driven(made->scene->start, {}, 0.0F);
  made->field_cost = evaluated(*made->scene, made->motion, made->field);
  return made->field_cost > 0.1 ? std::move(made) : nullptr;
}

}  // namespace

// CAND-022: the field at every third step, against differences of it by each number of the state there.
TEST(RefinementField, KnotSlopesAgreeWithDifferences) {
  const unsigned first = first_seed();
  std::vector<double> errors;
  for (unsigned seed = first; errors.size() < 1000; ++seed) {
    const auto made = in_a_field(seed);
    if (made == nullptr) continue;
    const test::RefinementScene& scene = *made->scene;
    const int k = static_cast<int>(seed % static_cast<unsigned>(kFieldKnots));
    const FieldKnot& knot = made->field.knots[k];
    if (knot.risk < 1000.0F) continue;
    const RefinementStep& step = scene.problem.steps[kFieldStride * k + kFieldStride - 1];
    const float slopes[] = {knot.by_along, knot.by_across, knot.by_heading, knot.by_speed, knot.by_curvature};
    const float steps[] = {0.02F, 0.02F, 0.002F, 0.05F, 0.0002F};
    const float lever[] = {2.0F, 2.0F, 0.1F, 2.0F, 0.05F};  // a change that matters
    for (int n = 0; n < 5; ++n) {
      const auto risk_at = [&](float by) {
        Motion moved = made->motion;
        MotionState& state = moved.states[kFieldStride * (k + 1)];
        if (n < 2) {
          state.x_m += by * (n == 0 ? step.along_x : -step.along_y);
          state.y_m += by * (n == 0 ? step.along_y : step.along_x);
        }
        if (n == 2) state.heading_rad += by;
        if (n == 3) state.speed_mps = max(state.speed_mps + by, 0.0F);
        if (n == 4) state.curvature_1pm += by;
        FieldAlong along;
        (void)evaluated(scene, moved, along);
        return along.knots[k].risk;
      };
      const float difference = (risk_at(steps[n]) - risk_at(-steps[n])) / (2.0F * steps[n]);
      errors.push_back(static_cast<double>(std::abs(slopes[n] - difference) /
                                           (std::abs(difference) + knot.risk / lever[n])));
    }
  }
  std::cout << "error of knots' slopes: median " << at(errors, 0.5) << ", p95 " << at(errors, 0.95) << '\n';
  EXPECT_LE(at(errors, 0.5), 0.002);
  EXPECT_LE(at(errors, 0.95), 0.03);
}

// CAND-022: slopes of cost and field together by the inputs, through motion, knots and residuals, against
// central differences of what the stage means to lower, along random directions. The optimizer lets the slope
// run straight from knot to knot, the differences the risk: what is left is that difference. The price of
// falling behind has a kink in its slope just here, and is left out.
TEST(RefinementField, SlopesAgreeWithDifferencesThroughTheWholeStage) {
  const unsigned first = first_seed();
  std::vector<double> errors;
  std::vector<double> field_shares;
  for (unsigned seed = first; errors.size() < 300; ++seed) {
    const auto made = in_a_field(seed);
    if (made == nullptr) continue;
    test::RefinementScene& scene = *made->scene;
    scene.problem.weights.behind = 0.0F;
    for (RefinementStep& step : scene.problem.steps)
      step.across_high_m = 0.5F;  // in the lane: evaluated across, too
    std::mt19937 random(seed);
    MotionInput direction[kHorizonSteps];
    const float phase = static_cast<float>(random() % 628U) * 0.01F;
    for (int i = 0; i < kHorizonSteps; ++i) {
      const float wave = 0.2F * static_cast<float>(i) + phase;
      direction[i] = {2.0F * std::sin(wave), 0.01F * std::cos(1.3F * wave)};
    }
    const auto cost_at = [&](float share) {
      const Motion moved = driven(made->motion, direction, share);
      FieldAlong along;
      return static_cast<double>(judge_motion(scene.problem, moved).own) + evaluated(scene, moved, along);
    };
    constexpr float kShare = 0.01F;
    const double difference = (cost_at(kShare) - cost_at(-kShare)) / (2.0 * static_cast<double>(kShare));
    const double without = slope_along(scene.problem, made->motion, direction);
    put_field(made->field, made->motion, 0.5F, scene.parameters, scene.problem);
    const double slope = slope_along(scene.problem, made->motion, direction);
    errors.push_back(std::abs(slope - difference) /
                     (std::abs(slope) + std::abs(without) + 0.05 * made->field_cost));
    field_shares.push_back(std::abs(slope - without) / (std::abs(slope) + std::abs(without) + 1e-9));
  }
  std::cout << "error of slopes: median " << at(errors, 0.5) << ", p95 " << at(errors, 0.95)
            << "; the field's share of them: median " << at(field_shares, 0.5) << '\n';
  EXPECT_LE(at(errors, 0.5), 0.03);
  EXPECT_LE(at(errors, 0.95), 0.25);
  EXPECT_GT(at(field_shares, 0.5), 0.1);
}

// Where it was evaluated, the residuals cost what the field does, but for R_0.
TEST(RefinementField, ResidualsCostWhatIsFelt) {
  const unsigned first = first_seed();
  for (unsigned seed = first, seen = 0; seen < 100; ++seed) {
    const auto made = in_a_field(seed);
    if (made == nullptr) continue;
    ++seen;
    put_field(made->field, made->motion, 0.5F, made->scene->parameters, made->scene->problem);
    EXPECT_NEAR(static_cast<double>(judge_motion(made->scene->problem, made->motion).field), made->field_cost,
                1e-3 * (made->field_cost + 1.0))
        << seed;
  }
}

// The optimizer's field is near the exact risk, also where somebody drives beside us and the ramp at our
// own axle takes a tenth of it away; and the field at every third step is near that at every step.
TEST(RefinementField, SmoothIsNearExact) {
  const unsigned first = first_seed();
  std::vector<double> smooth_errors;
  std::vector<double> knot_errors;
  for (unsigned seed = first; smooth_errors.size() < 300; ++seed) {
    const auto made = in_a_field(seed);
    if (made == nullptr) continue;
    const test::RefinementScene& scene = *made->scene;
    FieldAlong along;
    const double by_knots = evaluated(scene, scene.start, along);
    WorkMeter unbounded{kUnboundedWork};
    sadrf::SmoothRisk risks[kHorizonSteps];
    sadrf::smooth_risk(scene.scene, scene.prediction, scene.constant_velocity, scene.trajectory,
                       scene.parameters, 0, 1, risks, unbounded);
    double smooth = 0.0;
    for (const sadrf::SmoothRisk& risk : risks) smooth += static_cast<double>(kStepS * risk.value);
    smooth *= static_cast<double>(scene.parameters.scoring.risk);
    sadrf::DrivableArea nowhere;
    sadrf::RiskProfile profile;
    sadrf::exact_risk(scene.scene, nowhere, scene.prediction, scene.constant_velocity, scene.trajectory,
                      scene.parameters, profile);
    const double exact =
        static_cast<double>(scene.parameters.scoring.risk * sadrf::risk_integral(profile, scene.parameters));
    smooth_errors.push_back(std::abs(smooth - exact) / (exact + 0.1));
    knot_errors.push_back(std::abs(by_knots - smooth) / (exact + 0.1));
  }
  std::cout << "smooth against exact: median " << at(smooth_errors, 0.5) << ", p95 "
            << at(smooth_errors, 0.95) << "; every third step against all: median " << at(knot_errors, 0.5)
            << ", p95 " << at(knot_errors, 0.95) << '\n';
  EXPECT_LE(at(smooth_errors, 0.5), 0.15);
  EXPECT_LE(at(smooth_errors, 0.95), 0.35);
  EXPECT_LE(at(knot_errors, 0.5), 0.08);
}

// CAND-023: in a field that is evaluated at most three times, refining lowers cost and field together, by the
// exact risk too: of those that found anything most have less risk.
TEST(RefinementField, LowersTheExactRisk) {
  const unsigned first = first_seed();
  int improved = 0;
  int lower = 0;
  int cheaper = 0;
  double before = 0.0;
  double after = 0.0;
  for (unsigned seed = first, seen = 0; seen < 200; ++seed) {
    const auto made = in_a_field(seed);
    if (made == nullptr) continue;
    ++seen;
    const test::RefinementScene& scene = *made->scene;
    const auto exact = [&](const Trajectory& trajectory) {
      sadrf::DrivableArea nowhere;
      sadrf::RiskProfile profile;
      sadrf::exact_risk(scene.scene, nowhere, scene.prediction, scene.constant_velocity, trajectory,
                        scene.parameters, profile);
      return static_cast<double>(scene.parameters.scoring.risk *
                                 sadrf::risk_integral(profile, scene.parameters));
    };
    Trajectory refined;
    const RefinementResult result =
        std::make_unique<Optimizer>()->refine(scene.line, scene.candidate.start_s_m, scene.surroundings(),
                                              scene.parameters, {16, 3}, scene.trajectory, refined);
    EXPECT_LE(result.evaluations, 3) << seed;
    EXPECT_LE(result.passes, 16) << seed;
    if (!result.improved) continue;
    ++improved;
    const double field_before = exact(scene.trajectory);
    const double field_after = exact(refined);
    before += field_before;
    after += field_after;
    lower += field_after < field_before ? 1 : 0;
    cheaper += field_after - field_before + static_cast<double>(result.own_after - result.own_before) < 0.0;
  }
  std::cout << improved << " of 200 improved, " << lower << " less risk, " << cheaper
            << " cheaper by the exact risk; the field's cost " << before << " -> " << after << '\n';
  EXPECT_GT(improved, 150);
  EXPECT_GT(cheaper, 0.95 * improved);
  EXPECT_LT(after, 0.95 * before);
}

}  // namespace s4tp::trajectory
