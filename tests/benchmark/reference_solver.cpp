#include "tests/benchmark/reference_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <array>
#include <vector>

#include "tests/benchmark/second_order.hpp"

namespace s4tp::benchmark {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr int kSteps = kHorizonSteps;
constexpr int kPerStep =
    8;  // variables of step i: its two inputs, then the six entries of the state they lead to
constexpr int kCount = kPerStep * kSteps;
constexpr double kUnbounded = 1e19;

template <class T>
using State = std::array<T, 6>;  // x, y, psi, v, a, kappa
template <class T>
using Input = std::array<T, 2>;

template <class T>
T square(const T& x) {
  return x * x;
}

template <class T>
State<T> step_of(const State<T>& s, const Input<T>& u) {
  using std::cos;
  using std::sin;
  const double dt = static_cast<double>(kStepS);
  const double blend = static_cast<double>(kRestBlendMps);
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
  std::array<T, kMaxHalfPlanes> gap;
};

template <class T>
Deviations<T> deviations(const RefinementProblem& problem, const RefinementStep& step, const State<T>& s) {
  using std::abs;
  using std::cos;
  using std::sin;
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
  for (int k = 0; k < step.half_plane_count; ++k) {
    const HalfPlane& plane = step.half_planes[k];
    const double nx = plane.normal_x;
    const double ny = plane.normal_y;
    const T ahead = nx * cos(s[2]) + ny * sin(s[2]);
    const T left = ny * cos(s[2]) - nx * sin(s[2]);
    d.gap[static_cast<std::size_t>(k)] = nx * s[0] + ny * s[1] + double{problem.centre_m} * ahead -
                                         T(plane.offset_m) - double{problem.half_length_m} * abs(ahead) -
                                         double{problem.half_width_m} * abs(left);
  }
  return d;
}

template <class T>
T cost_of(const RefinementProblem& problem, int index, const Input<T>& u, const State<T>& s) {
  const RefinementStep& step = problem.steps[index];
  const RefinementWeights& w = problem.weights;
  const double tie = index == kSteps - 1 ? double{problem.end_importance} : 1.0;
  const Deviations<T> d = deviations(problem, step, s);
  T sum = double{w.jerk} * square(u[0]) + double{step.curvature_rate_weight} * square(u[1]);
  sum = sum + tie * (double{w.along} * square(d.along) + double{w.across} * square(d.across) +
                     double{w.heading} * square(d.heading) +
                     double{w.speed} * square(s[3] - T(step.reference.speed_mps)));
  sum = sum + double{w.lane} * square(T(step.lane_offset_m) + d.across);
  sum = sum + double{w.lateral} * square(d.lateral);
  const T over = s[3] - T(step.speed_cap_mps);
  if (over > 0.0) sum = sum + double{w.over_cap} * square(over);
  for (int k = 0; k < step.half_plane_count; ++k) {
    const T lacking = T(problem.comfort_gap_m) - d.gap[static_cast<std::size_t>(k)];
    if (lacking > 0.0) sum = sum + double{w.clearance} * square(lacking);
  }
  return 0.5 * sum;
}

State<double> numbers(const MotionState& s) {
  return {s.x_m, s.y_m, s.heading_rad, s.speed_mps, s.acceleration_mps2, s.curvature_1pm};
}

/// The problem by multiple shooting, as Ipopt asks for it.
class ShootingProblem final : public Ipopt::TNLP {
 public:
  ShootingProblem(const RefinementProblem& problem, const Motion& start) : problem_(problem), start_(start) {}

  double cost = 0.0;
  bool converged = false;

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = kCount;
    m = 0;
    jacobian = 0;
    hessian = 0;
    for (int i = 0; i < kSteps; ++i) {
      const int bounds = 3 + problem_.steps[i].half_plane_count;
      m += 6 + bounds;
      jacobian += 6 * (1 + (i > 0 ? 8 : 2)) + 6 * bounds;
      hessian += (i > 0 ? 36 : 3) + 21 + 2;
    }
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* low, Number* high, Index, Number* row_low, Number* row_high) override {
    int row = 0;
    for (int i = 0; i < kSteps; ++i) {
      const RefinementStep& step = problem_.steps[i];
      Number* const l = low + kPerStep * i;
      Number* const h = high + kPerStep * i;
      h[0] = step.input_bound.jerk_mps3;
      h[1] = step.input_bound.curvature_rate_1pms;
      l[0] = -h[0];
      l[1] = -h[1];
      for (int k = 2; k < kPerStep; ++k) l[k] = -kUnbounded, h[k] = kUnbounded;
      l[6] = problem_.acceleration_low_mps2;
      h[6] = problem_.acceleration_high_mps2;
      h[7] = problem_.curvature_bound_1pm;
      l[7] = -h[7];
      for (int k = 0; k < 6; ++k, ++row) row_low[row] = row_high[row] = 0.0;
      const double symmetric[3] = {step.along_bound_m, problem_.across_bound_m, problem_.lateral_bound_mps2};
      for (int k = 0; k < 3; ++k, ++row) {
        row_low[row] = -symmetric[k];
        row_high[row] = symmetric[k];
      }
      for (int k = 0; k < step.half_plane_count; ++k, ++row) {
        row_low[row] = step.half_planes[k].least_gap_m;
        row_high[row] = kUnbounded;
      }
    }
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    for (int i = 0; i < kSteps; ++i) {
      Number* const block = x + kPerStep * i;
      block[0] = start_.inputs[i].jerk_mps3;
      block[1] = start_.inputs[i].curvature_rate_1pms;
      const State<double> state = numbers(start_.states[i + 1]);
      for (std::size_t k = 0; k < 6; ++k) block[2 + k] = state[k];
    }
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = 0.0;
    for (int i = 0; i < kSteps; ++i) value += cost_of<double>(problem_, i, input(x, i), state(x, i + 1));
    return true;
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    for (int i = 0; i < kSteps; ++i) {
      const Jet jet = stage_cost(x, i);
      for (std::size_t k = 0; k < kVariables; ++k)
        gradient[kPerStep * i + static_cast<int>(k)] = jet.gradient[k];
    }
    return true;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* rows) override {
    int row = 0;
    for (int i = 0; i < kSteps; ++i) {
      const State<double> reached = step_of<double>(state(x, i), input(x, i));
      const State<double> next = state(x, i + 1);
      for (std::size_t k = 0; k < 6; ++k) rows[row++] = next[k] - reached[k];
      const Deviations<double> d = deviations(problem_, problem_.steps[i], next);
      for (const double value : {d.along, d.across, d.lateral}) rows[row++] = value;
      for (int k = 0; k < problem_.steps[i].half_plane_count; ++k)
        rows[row++] = d.gap[static_cast<std::size_t>(k)];
    }
    return true;
  }

  bool eval_jac_g(Index, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    int at = 0;
    int row = 0;
    const auto put = [&](int r, int c, double value) {
      if (values == nullptr) {
        rows[at] = r;
        columns[at] = c;
      } else {
        values[at] = value;
      }
      ++at;
    };
    for (int i = 0; i < kSteps; ++i) {
      State<Jet> reached;
      if (values != nullptr) reached = stage_motion(x, i);
      for (int k = 0; k < 6; ++k, ++row) {
        const Jet& entry = reached[static_cast<std::size_t>(k)];
        put(row, kPerStep * i + 2 + k, 1.0);
        for (int c = i > 0 ? 0 : 6; c < kPerStep; ++c)
          put(row, column(i, c), -entry.gradient[static_cast<std::size_t>(c)]);
      }
      std::vector<Jet> bounded(3 + static_cast<std::size_t>(problem_.steps[i].half_plane_count));
      if (values != nullptr) bounded = stage_bounds(x, i);
      for (const Jet& entry : bounded) {
        for (int c = 2; c < kPerStep; ++c)
          put(row, kPerStep * i + c, entry.gradient[static_cast<std::size_t>(c)]);
        ++row;
      }
    }
    return true;
  }

  bool eval_h(Index, const Number* x, bool, Number factor, Index, const Number* multipliers, bool, Index,
              Index* rows, Index* columns, Number* values) override {
    int at = 0;
    int row = 0;
    const auto put = [&](int r, int c, double value) {
      if (values == nullptr) {
        rows[at] = r > c ? r : c;
        columns[at] = r > c ? c : r;
      } else {
        values[at] = value;
      }
      ++at;
    };
    for (int i = 0; i < kSteps; ++i) {
      Jet motion;
      Jet stage;
      if (values != nullptr) {
        const State<Jet> reached = stage_motion(x, i);
        for (int k = 0; k < 6; ++k)
          motion = motion - Jet(multipliers[row + k]) * reached[static_cast<std::size_t>(k)];
        stage = Jet(factor) * stage_cost(x, i);
        const std::vector<Jet> bounded = stage_bounds(x, i);
        for (std::size_t k = 0; k < bounded.size(); ++k) {
          stage = stage + Jet(multipliers[row + 6 + static_cast<int>(k)]) * bounded[k];
        }
      }
      row += 9 + problem_.steps[i].half_plane_count;
      for (int r = i > 0 ? 0 : 6; r < kPerStep; ++r) {
        for (int c = i > 0 ? 0 : 6; c <= r; ++c) {
          put(column(i, r), column(i, c),
              motion.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]);
        }
      }
      for (int r = 2; r < kPerStep; ++r) {
        for (int c = 2; c <= r; ++c) {
          put(kPerStep * i + r, kPerStep * i + c,
              stage.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]);
        }
      }
      for (int r = 0; r < 2; ++r) {
        put(kPerStep * i + r, kPerStep * i + r,
            stage.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(r)]);
      }
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn status, Index, const Number*, const Number*, const Number*,
                         Index, const Number*, const Number*, Number value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    cost = value;
    converged = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
  }

 private:
  /// Variable `c` of step_of at step i: six of the state before, then the inputs.
  [[nodiscard]] static int column(int i, int c) {
    return c < 6 ? kPerStep * (i - 1) + 2 + c : kPerStep * i + c - 6;
  }

  [[nodiscard]] static Input<double> input(const Number* x, int i) {
    return {x[kPerStep * i], x[kPerStep * i + 1]};
  }
  /// states[i]; the start is no variable.
  [[nodiscard]] State<double> state(const Number* x, int i) const {
    if (i == 0) return numbers(problem_.start);
    const Number* const s = x + kPerStep * (i - 1) + 2;
    return {s[0], s[1], s[2], s[3], s[4], s[5]};
  }
  [[nodiscard]] State<Jet> stage_motion(const Number* x, int i) const {
    const State<double> at = state(x, i);
    State<Jet> s;
    for (std::size_t k = 0; k < 6; ++k) s[k] = Jet(at[k], k);
    const Input<double> u = input(x, i);
    return step_of<Jet>(s, {Jet(u[0], 6), Jet(u[1], 7)});
  }
  /// Variables: the inputs, then the state they lead to.
  [[nodiscard]] State<Jet> next_state(const Number* x, int i) const {
    const State<double> at = state(x, i + 1);
    State<Jet> s;
    for (std::size_t k = 0; k < 6; ++k) s[k] = Jet(at[k], k + 2);
    return s;
  }
  [[nodiscard]] Jet stage_cost(const Number* x, int i) const {
    const Input<double> u = input(x, i);
    return cost_of<Jet>(problem_, i, {Jet(u[0], 0), Jet(u[1], 1)}, next_state(x, i));
  }
  [[nodiscard]] std::vector<Jet> stage_bounds(const Number* x, int i) const {
    const Deviations<Jet> d = deviations(problem_, problem_.steps[i], next_state(x, i));
    std::vector<Jet> bounded = {d.along, d.across, d.lateral};
    for (int k = 0; k < problem_.steps[i].half_plane_count; ++k)
      bounded.push_back(d.gap[static_cast<std::size_t>(k)]);
    return bounded;
  }

  const RefinementProblem& problem_;
  const Motion& start_;
};

}  // namespace

double cost_in_double(const RefinementProblem& problem, const Motion& motion) {
  double cost = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    cost += cost_of<double>(problem, i, {motion.inputs[i].jerk_mps3, motion.inputs[i].curvature_rate_1pms},
                            numbers(motion.states[i + 1]));
  }
  return cost;
}

ReferenceResult solve_by_ipopt(const RefinementProblem& problem, const Motion& start) {
  const Ipopt::SmartPtr<ShootingProblem> nlp = new ShootingProblem(problem, start);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetStringValue("sb", "yes");
  ipopt->Options()->SetNumericValue("tol", 1e-7);
  ipopt->Options()->SetIntegerValue("max_iter", 500);
  if (ipopt->Initialize() != Ipopt::Solve_Succeeded) return {};
  (void)ipopt->OptimizeTNLP(nlp);
  const Ipopt::SmartPtr<Ipopt::SolveStatistics> statistics = ipopt->Statistics();
  return {nlp->converged, nlp->cost, IsValid(statistics) ? statistics->IterationCount() : 0};
}

}  // namespace s4tp::benchmark
