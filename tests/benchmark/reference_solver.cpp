#include "tests/benchmark/reference_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

#include "tests/benchmark/reference_model.hpp"

namespace s4tp::benchmark {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr int kSteps = kHorizonSteps;
// Variables of step i: its two inputs, the six entries of the state they lead to, the excesses there.
constexpr int kJetVariables = static_cast<int>(kVariables);
constexpr int kPerStep = kJetVariables + kExcesses;
constexpr int kCount = kPerStep * kSteps;
constexpr double kKept = 1e-4;  // a bound broken by no more

State<double> numbers(const trajectory::MotionState& s) {
  return {s.x_m, s.y_m, s.heading_rad, s.speed_mps, s.acceleration_mps2, s.curvature_1pm};
}

double worst(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

/// Cost and violation of one step, its inputs' bounds included.
void judge_step(const trajectory::RefinementProblem& problem, int index, const Input<double>& u,
                const State<double>& s, DoubleJudgement& judgement) {
  const trajectory::RefinementStep& step = problem.steps[index];
  const Excesses excess = excesses(problem, step, s);
  judgement.cost += smooth_cost<double>(problem, index, u, s);
  for (int k = 0; k < kExcesses; ++k) {
    judgement.cost += 0.5 * excess_weight(problem, k) * square(excess[static_cast<std::size_t>(k)]);
  }
  double& violation = judgement.violation;
  for (const Row<double>& row : bounded_rows<double>(problem, step, s)) {
    if (row.excess < 0) violation = std::max(violation, worst(row.value, row.low, row.high));
  }
  const double bend = problem.curvature_bound_1pm;
  const double jerk = step.input_bound.jerk_mps3;
  const double rate = step.input_bound.curvature_rate_1pms;
  violation = std::max({violation, worst(s[4], problem.acceleration_low_mps2, problem.acceleration_high_mps2),
                        worst(s[5], -bend, bend), worst(u[0], -jerk, jerk), worst(u[1], -rate, rate)});
}

/// The problem by multiple shooting, as Ipopt asks for it.
class ShootingProblem : public Ipopt::TNLP {
 public:
  ShootingProblem(const trajectory::RefinementProblem& problem, const trajectory::Motion& start)
      : problem_(problem), start_(start) {}

  bool solved = false;
  double cost = 0.0;

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = kCount;
    m = 0;
    jacobian = 0;
    hessian = 0;
    for (int i = 0; i < kSteps; ++i) {
      const int planes = problem_.steps[i].half_plane_count;
      const int rows = 4 + 2 * kCorners * planes;
      m += 6 + rows;
      jacobian += 6 * (1 + (i > 0 ? 8 : 2)) + 6 * rows + 1 + kCorners * planes;
      hessian += (i > 0 ? 36 : 3) + 21 + 2 + kExcesses;
    }
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* low, Number* high, Index, Number* row_low, Number* row_high) override {
    int row = 0;
    for (int i = 0; i < kSteps; ++i) {
      const trajectory::RefinementStep& step = problem_.steps[i];
      Number* const l = low + kPerStep * i;
      Number* const h = high + kPerStep * i;
      h[0] = step.input_bound.jerk_mps3;
      h[1] = step.input_bound.curvature_rate_1pms;
      l[0] = -h[0];
      l[1] = -h[1];
      for (int k = 2; k < kJetVariables; ++k) l[k] = -kUnbounded, h[k] = kUnbounded;
      l[6] = problem_.acceleration_low_mps2;
      h[6] = problem_.acceleration_high_mps2;
      h[7] = problem_.curvature_bound_1pm;
      l[7] = -h[7];
      for (int k = 0; k < kExcesses; ++k) {
        l[kJetVariables + k] = 0.0;
        h[kJetVariables + k] = k <= step.half_plane_count ? kUnbounded : 0.0;
      }
      for (int k = 0; k < 6; ++k, ++row) row_low[row] = row_high[row] = 0.0;
      for (const Row<double>& bounded : bounded_rows<double>(problem_, step, numbers(start_.states[i + 1]))) {
        row_low[row] = bounded.low;
        row_high[row++] = bounded.high;
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
      std::copy(state.begin(), state.end(), block + 2);
      const Excesses excess = excesses(problem_, problem_.steps[i], state);
      std::copy(excess.begin(), excess.end(), block + kJetVariables);
    }
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    value = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      value += smooth_cost<double>(problem_, i, input(x, i), state(x, i + 1));
      for (int k = 0; k < kExcesses; ++k) {
        value += 0.5 * excess_weight(problem_, k) * square(x[kPerStep * i + kJetVariables + k]);
      }
    }
    return true;
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    for (int i = 0; i < kSteps; ++i) {
      Number* const block = gradient + kPerStep * i;
      const Jet jet = stage_cost(x, i);
      std::copy(jet.gradient.begin(), jet.gradient.end(), block);
      for (int k = kJetVariables; k < kPerStep; ++k) {
        block[k] = excess_weight(problem_, k - kJetVariables) * x[kPerStep * i + k];
      }
    }
    return true;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* rows) override {
    int row = 0;
    for (int i = 0; i < kSteps; ++i) {
      const State<double> reached = step_of<double>(state(x, i), input(x, i));
      const State<double> next = state(x, i + 1);
      for (std::size_t k = 0; k < 6; ++k) rows[row++] = next[k] - reached[k];
      for (const Row<double>& bounded : bounded_rows<double>(problem_, problem_.steps[i], next)) {
        const double excess = bounded.excess < 0 ? 0.0 : x[kPerStep * i + kJetVariables + bounded.excess];
        rows[row++] = bounded.value + bounded.share * excess;
      }
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
        for (int c = i > 0 ? 0 : 6; c < kJetVariables; ++c)
          put(row, column(i, c), -entry.gradient[static_cast<std::size_t>(c)]);
      }
      for (const Row<Jet>& bounded : stage_rows(x, i)) {
        for (int c = 2; c < kJetVariables; ++c)
          put(row, kPerStep * i + c, bounded.value.gradient[static_cast<std::size_t>(c)]);
        if (bounded.excess >= 0) put(row, kPerStep * i + kJetVariables + bounded.excess, bounded.share);
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
        for (const Jet& entry : reached) motion = motion - Jet(multipliers[row++]) * entry;
        stage = Jet(factor) * stage_cost(x, i);
        for (const Row<Jet>& bounded : stage_rows(x, i))
          stage = stage + Jet(multipliers[row++]) * bounded.value;
      }
      for (int r = i > 0 ? 0 : 6; r < kJetVariables; ++r) {
        for (int c = i > 0 ? 0 : 6; c <= r; ++c) {
          put(column(i, r), column(i, c),
              motion.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]);
        }
      }
      for (int r = 2; r < kJetVariables; ++r) {
        for (int c = 2; c <= r; ++c) {
          put(kPerStep * i + r, kPerStep * i + c,
              stage.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]);
        }
      }
      for (int r = 0; r < 2; ++r) {
        put(kPerStep * i + r, kPerStep * i + r,
            stage.hessian[static_cast<std::size_t>(r)][static_cast<std::size_t>(r)]);
      }
      for (int k = 0; k < kExcesses; ++k) {
        const int variable = kPerStep * i + kJetVariables + k;
        put(variable, variable, factor * excess_weight(problem_, k));
      }
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn status, Index, const Number* x, const Number*, const Number*,
                         Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    DoubleJudgement judgement;
    State<double> driven = numbers(problem_.start);
    for (int i = 0; i < kSteps; ++i) {
      driven = step_of<double>(driven, input(x, i));
      judge_step(problem_, i, input(x, i), driven, judgement);
    }
    cost = judgement.cost;
    solved = status == Ipopt::SUCCESS && judgement.violation <= kKept;
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
    State<Jet> s;
    if (x == nullptr) return s;  // only the structure is asked for
    const State<double> at = state(x, i + 1);
    for (std::size_t k = 0; k < 6; ++k) s[k] = Jet(at[k], k + 2);
    return s;
  }
  [[nodiscard]] Jet stage_cost(const Number* x, int i) const {
    const Input<double> u = input(x, i);
    return smooth_cost<Jet>(problem_, i, {Jet(u[0], 0), Jet(u[1], 1)}, next_state(x, i));
  }
  [[nodiscard]] std::vector<Row<Jet>> stage_rows(const Number* x, int i) const {
    return bounded_rows<Jet>(problem_, problem_.steps[i], next_state(x, i));
  }

  const trajectory::RefinementProblem& problem_;
  const trajectory::Motion& start_;
};

}  // namespace

DoubleJudgement judge_in_double(const trajectory::RefinementProblem& problem,
                                const trajectory::Motion& motion) {
  DoubleJudgement judgement;
  for (int i = 0; i < kSteps; ++i) {
    judge_step(problem, i, {motion.inputs[i].jerk_mps3, motion.inputs[i].curvature_rate_1pms},
               numbers(motion.states[i + 1]), judgement);
  }
  return judgement;
}

ReferenceResult solve_by_ipopt(const trajectory::RefinementProblem& problem,
                               const trajectory::Motion& start) {
  const Ipopt::SmartPtr<ShootingProblem> nlp = new ShootingProblem(problem, start);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetStringValue("sb", "yes");
  ipopt->Options()->SetNumericValue("tol", 1e-7);
  ipopt->Options()->SetIntegerValue("acceptable_iter", 0);
  ipopt->Options()->SetIntegerValue("max_iter", 500);
  if (ipopt->Initialize() != Ipopt::Solve_Succeeded) return {};
  (void)ipopt->OptimizeTNLP(nlp);
  const Ipopt::SmartPtr<Ipopt::SolveStatistics> statistics = ipopt->Statistics();
  return {nlp->solved, nlp->cost, IsValid(statistics) ? statistics->IterationCount() : 0};
}

}  // namespace s4tp::benchmark
