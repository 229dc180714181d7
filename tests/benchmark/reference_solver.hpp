#pragma once
/// The optimizer's problem in double precision, and its local optimum by Ipopt: an independent statement of
/// model, cost and bounds with exact second derivatives.

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::benchmark {

struct DoubleJudgement {
  double cost = 0.0;
  double violation = 0.0;  ///< of the worst bound, in its own unit: m, m/s^2, 1/m
};
/// As the problem defines them, computed in double from a motion's states and inputs.
[[nodiscard]] DoubleJudgement judge_in_double(const trajectory::RefinementProblem& problem,
                                              const trajectory::Motion& motion);

struct ReferenceResult {
  /// Ipopt's own word (tolerance 1e-7 on optimality, no "acceptable" point counts), and the inputs it found,
  /// driven again from the start, break no bound by more than 1e-4 of its unit.
  bool solved = false;
  double cost = 0.0;  ///< of the inputs driven again: an exact motion of the model
  int iterations = 0;
};

/// \param start  where the search begins; need not keep any bound
[[nodiscard]] ReferenceResult solve_by_ipopt(const trajectory::RefinementProblem& problem,
                                             const trajectory::Motion& start);

}  // namespace s4tp::benchmark
