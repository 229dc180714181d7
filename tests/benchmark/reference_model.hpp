#pragma once
/// The optimizer's problem stated again, in double, for numbers and for Jets. Kinks are written as bounds,
/// which leaves everything twice differentiable but for the model's coming to rest: a gap is the least over
/// the corners of our box, so each corner keeps it; and what costs only beyond a limit costs the square of an
/// excess e >= 0 that makes up for what is lacking.

#include <algorithm>
#include <array>
#include <vector>

#include "algo/trajectory/ilqr_problem.hpp"
#include "tests/benchmark/second_order.hpp"

namespace s4tp::benchmark {

template <class T>
using State = std::array<T, 6>;  ///< x, y, psi, v, a, kappa
template <class T>
using Input = std::array<T, 2>;  ///< jerk, curvature rate

inline constexpr int kExcesses =
    1 + trajectory::kMaxHalfPlanes;  ///< of each step: over the speed cap, short of each comfort gap
using Excesses = std::array<double, kExcesses>;
inline constexpr int kCorners = 4;

template <class T>
T square(const T& x) {
  return x * x;
}

/// ilqr_dynamics.hpp
template <class T>
State<T> step_of(const State<T>& s, const Input<T>& u) {
  using std::cos;
  using std::sin;
  const double dt = static_cast<double>(kStepS);
  const double blend = static_cast<double>(trajectory::kRestBlendMps);
  const T free = s[3] + dt * s[4] + 0.5 * dt * dt * u[0];
  const T t = (1.0 / blend) * free;
  T speed = free;
  if (free < blend) speed = free > 0.0 ? blend * (t * t * (T(2.0) - t)) : T(0.0);
  const T way = 0.5 * dt * (s[3] + speed);
  const T turn = (s[5] + 0.5 * dt * u[1]) * way;
  const T middle = s[2] + 0.5 * turn;
  return {s[0] + way * cos(middle), s[1] + way * sin(middle), s[2] + turn, speed,
          s[4] + dt * u[0],         s[5] + dt * u[1]};
}

template <class T>
struct Deviations {
  T along, across, heading, lateral;
};

template <class T>
Deviations<T> deviations(const trajectory::RefinementStep& step, const State<T>& s) {
  const double bend = step.reference.curvature_1pm;
  const T dx = s[0] - T(step.reference.x_m);
  const T dy = s[1] - T(step.reference.y_m);
  const double tx = step.along_x;
  const double ty = step.along_y;
  Deviations<T> d;
  d.along = tx * dx + ty * dy;
  d.across = tx * dy - ty * dx - 0.5 * bend * square(d.along);
  d.heading = s[2] - T(step.reference.heading_rad) - bend * d.along;
  d.lateral = square(s[3]) * s[5];
  return d;
}

/// Distance of each corner of our box from a half-plane.
template <class T>
std::array<T, kCorners> corner_gaps(const trajectory::RefinementProblem& problem,
                                    const trajectory::HalfPlane& plane, const State<T>& s) {
  using std::cos;
  using std::sin;
  const double nx = plane.normal_x;
  const double ny = plane.normal_y;
  const T ahead = nx * cos(s[2]) + ny * sin(s[2]);
  const T left = ny * cos(s[2]) - nx * sin(s[2]);
  std::array<T, kCorners> gaps;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const double to_end = double{problem.centre_m} + (k < 2 ? 1.0 : -1.0) * double{problem.half_length_m};
    const double to_side = (k % 2 == 0 ? 1.0 : -1.0) * double{problem.half_width_m};
    gaps[k] = nx * s[0] + ny * s[1] + to_end * ahead + to_side * left - T(plane.offset_m);
  }
  return gaps;
}

/// The risk field as last put into the problem (refinement_field.hpp), R_0's share taken off.
template <class T>
T field_cost(const trajectory::RefinementProblem& problem, const trajectory::RefinementStep& step,
             const State<T>& s) {
  const trajectory::FieldResidual& field = step.field;
  const T root = double{field.by_x} * s[0] + double{field.by_y} * s[1] + double{field.by_heading} * s[2] +
                 double{field.by_speed} * s[3] + double{field.by_curvature} * s[5] + T(field.offset);
  return 0.5 * square(root) - T(double{problem.field_constant} / kHorizonSteps);
}

/// Of inputs[index] and states[index + 1], without the excesses' part.
template <class T>
T smooth_cost(const trajectory::RefinementProblem& problem, int index, const Input<T>& u, const State<T>& s) {
  const trajectory::RefinementStep& step = problem.steps[index];
  const trajectory::RefinementWeights& w = problem.weights;
  const double tie = index == kHorizonSteps - 1 ? double{problem.end_importance} : 1.0;
  const Deviations<T> d = deviations(step, s);
  T sum = double{w.jerk} * square(u[0]) + double{step.curvature_rate_weight} * square(u[1]);
  sum = sum + tie * (double{w.along} * square(d.along) + double{w.across} * square(d.across) +
                     double{w.heading} * square(d.heading) +
                     double{w.speed} * square(s[3] - T(step.reference.speed_mps)));
  if (index == kHorizonSteps - 1 && d.along < 0.0) {
    const double blend = trajectory::kBehindBlendM;
    const T lacking = T(0.0) - d.along;
    const double twice = 2.0 * double{w.behind};
    if (lacking < blend) {
      sum = sum + (0.5 * twice / blend) * square(lacking);
    } else {
      sum = sum + twice * (lacking - T(0.5 * blend));
    }
  }
  sum = sum + double{w.lane} * square(T(step.lane_offset_m) + d.across);
  sum = sum + double{w.lateral} * square(d.lateral);
  return 0.5 * sum + field_cost(problem, step, s);
}

/// Excess k of a step costs half of this times its square.
inline double excess_weight(const trajectory::RefinementProblem& problem, int k) {
  return k == 0 ? problem.weights.over_cap : problem.weights.clearance;
}

/// The least excesses a state leaves.
inline Excesses excesses(const trajectory::RefinementProblem& problem, const trajectory::RefinementStep& step,
                         const State<double>& s) {
  Excesses least{};
  least[0] = std::max(0.0, s[3] - double{step.speed_cap_mps});
  for (int k = 0; k < step.half_plane_count; ++k) {
    const auto gaps = corner_gaps(problem, step.half_planes[k], s);
    least[static_cast<std::size_t>(k) + 1] =
        std::max(0.0, double{problem.comfort_gap_m} - *std::min_element(gaps.begin(), gaps.end()));
  }
  return least;
}

/// What is bounded in a state by more than itself: low <= value + share * excesses[excess] <= high.
template <class T>
struct Row {
  T value;
  double low;
  double high;
  int excess = -1;  ///< none
  double share = 0.0;
};

inline constexpr double kUnbounded = 1e19;  ///< as Ipopt means it

template <class T>
std::vector<Row<T>> bounded_rows(const trajectory::RefinementProblem& problem,
                                 const trajectory::RefinementStep& step, const State<T>& s) {
  const Deviations<T> d = deviations(step, s);
  const double lateral = problem.lateral_bound_mps2;
  // Nor further from where the field was evaluated than it is trusted.
  const auto trusted = [&](const T& value, double centre, double low, double high) {
    return Row<T>{value, std::max(low, centre - double{problem.trust_m}),
                  std::min(high, centre + double{problem.trust_m})};
  };
  std::vector<Row<T>> rows = {trusted(d.along, step.trusted_along_m, -step.along_bound_m, step.along_bound_m),
                              trusted(d.across, step.trusted_across_m, step.across_low_m, step.across_high_m),
                              {d.lateral, -lateral, lateral},
                              {s[3], -kUnbounded, double{step.speed_cap_mps}, 0, -1.0}};
  for (int k = 0; k < step.half_plane_count; ++k) {
    const trajectory::HalfPlane& plane = step.half_planes[k];
    for (const T& gap : corner_gaps(problem, plane, s)) {
      rows.push_back({gap, double{plane.least_gap_m}, kUnbounded});
      rows.push_back({gap, double{problem.comfort_gap_m}, kUnbounded, k + 1, 1.0});
    }
  }
  return rows;
}

}  // namespace s4tp::benchmark
