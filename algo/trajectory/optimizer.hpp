#pragma once
/// Refinement of the chosen candidate (METHOD 4.5): smoother, within the vehicle's limits, clear of the
/// predicted boxes, and near enough to the candidate for its prediction to hold.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/trajectory/clearance.hpp"
#include "algo/trajectory/ilqr.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp {

inline constexpr float kRefinedWithinM = 1.0F;  ///< of the candidate, along and across
inline constexpr float kRefinedWithinS = 0.5F;  ///< of it in time: a stop stays where it is

/// Writes what refining `trajectory` means.
/// \param line  the reference line of its path. \param start_s_m  where on it the trajectory starts
void build_refinement(const ReferenceLine& line, float start_s_m, const Surroundings& surroundings,
                      const Parameters& parameters, const Trajectory& trajectory, RefinementProblem& problem);

class Optimizer {
 public:
  /// CAND-011 Never worse than its start: the result costs no more than `trajectory` did, or is
  /// `trajectory` itself, to the bit. CAND-013 Standing still stays standing still, to the bit.
  /// CAND-014 Within kRefinedWithinM and kRefinedWithinS of it, and where it kept its distance from a
  /// predicted box, so does the result. \param trajectory  in: the chosen candidate; out: the refined one,
  /// same start \param allowance   most passes
  [[nodiscard]] IlqrResult refine(const ReferenceLine& line, float start_s_m,
                                  const Surroundings& surroundings, const Parameters& parameters,
                                  int allowance, Trajectory& trajectory);

  /// Of the last refine() with an allowance.
  [[nodiscard]] const RefinementProblem& problem() const { return problem_; }

 private:
  RefinementProblem problem_;
  Motion motion_;
  Ilqr ilqr_;
};

}  // namespace s4tp
