#pragma once
/// The optimizer's problem in double precision, and its local optimum by Ipopt: an independent statement of
/// model, cost and bounds with exact second derivatives.

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::benchmark {

/// Cost of a motion as the problem defines it, computed in double from its states and inputs.
[[nodiscard]] double cost_in_double(const RefinementProblem& problem, const Motion& motion);

struct ReferenceResult {
  bool converged = false;
  double cost = 0.0;
  int iterations = 0;
};

/// \param start  where the search begins; need not keep any bound
[[nodiscard]] ReferenceResult solve_by_ipopt(const RefinementProblem& problem, const Motion& start);

}  // namespace s4tp::benchmark
