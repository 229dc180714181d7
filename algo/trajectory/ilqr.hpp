#pragma once
/// Control-limited Gauss-Newton iLQR with an augmented Lagrangian for the bounds (method.md 4.8): each pass
/// linearises about the nominal motion, solves the linear-quadratic problem backwards, and tries its
/// corrections forwards, whole and in fixed shares. Sources: Tassa et al. 2014 (input bounds), Howell et al.
/// 2019 (ALTRO).

#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::trajectory {

inline constexpr int kMotionStates = 6;  ///< x, y, psi, v, a, kappa

/// Correction of one step's inputs: `open` + feedback . (state - nominal state).
struct InputCorrection {
  float open[2];                      ///< jerk, curvature rate
  float feedback[2 * kMotionStates];  ///< a column for each state
};

inline constexpr int kTrialsPerPass = 6;  ///< trials that fail cost as much as a pass

/// Work done, in passes.
[[nodiscard]] constexpr int passes_spent(int passes, int failed_trials) {
  return passes + (failed_trials + kTrialsPerPass - 1) / kTrialsPerPass;
}

struct IlqrResult {
  int passes = 0;
  int failed_trials = 0;  ///< shares of corrections rolled out in vain
  float cost_before = 0.0F;
  float cost_after = 0.0F;  ///< <= cost_before
  bool improved = false;    ///< false: the motion is as it was, to the bit
};

class Ilqr {
 public:
  /// \param allowance  most passes: the unit of work; every six failed trials count as one. A cut is no
  /// failure: what is returned is the best so far that keeps all bounds, or the start. \param motion  in: the
  /// start, not necessarily an exact motion of the model; out: the best one found
  [[nodiscard]] IlqrResult solve(const RefinementProblem& problem, int allowance, Motion& motion);

 private:
  void follow(const RefinementProblem& problem, const Motion& start);
  float merit_of_nominal(const RefinementProblem& problem) const;
  /// Rolls out `share` of the corrections into trial_. \return its merit, or more than `limit`
  float try_share(const RefinementProblem& problem, float share, float limit);
  void keep_if_best(const RefinementProblem& problem, Motion& best, IlqrResult& result,
                    float& violation) const;

  Motion nominal_;
  Motion trial_;
  InputCorrection corrections_[kHorizonSteps];
  BoundState bounds_;
};

}  // namespace s4tp::trajectory
