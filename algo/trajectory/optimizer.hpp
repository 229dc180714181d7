#pragma once
/// Refinement of the chosen candidate in the risk field (method.md 4.8): less risk, calmer, within
/// the vehicle's limits, clear of the predicted boxes, and near enough to the candidate for its prediction to
/// hold.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/trajectory/clearance.hpp"
#include "algo/trajectory/ilqr.hpp"
#include "algo/trajectory/reference_line.hpp"
#include "algo/trajectory/refinement_field.hpp"

namespace s4tp::trajectory {

inline constexpr float kRefinedAlongM = 2.0F;   ///< of the candidate
inline constexpr float kRefinedWithinS = 0.5F;  ///< of it in time: a stop stays where it is
inline constexpr float kRefinedInLaneM = 0.3F;  ///< of the lane's centre, if the candidate is as near
/// Writes what refining `trajectory` means.
/// \param line  the reference line of its path. \param start_s_m  where on it the trajectory starts
void build_refinement(const ReferenceLine& line, float start_s_m, const Surroundings& surroundings,
                      const Parameters& parameters, const Trajectory& trajectory, RefinementProblem& problem);

/// Units of work of a refinement.
struct RefinementAllowance {
  int passes = 0;
  int evaluations = 0;  ///< times the field is evaluated along a motion; 0: it is left out
  std::int32_t field_work = kUnboundedWork;  ///< for all of them together [WorkMeter's units]
};

struct RefinementResult {
  int passes = 0;
  int failed_trials = 0;
  int evaluations = 0;          ///< 0: there was no field, or nothing in it
  std::int32_t field_work = 0;  ///< what all took that were made
  bool improved = false;        ///< false: the trajectory is as it was, to the bit
  float own_before = 0.0F;      ///< cost without the field
  float own_after = 0.0F;       ///< of the best motion found, of one that could not be driven too
  float field_before = 0.0F;    ///< what the field adds, smooth and linear between every third step
  float field_after = 0.0F;     ///< as its last linear model has it
};

class Optimizer {
 public:
  /// CAND-011 Never worse than its start: by the model that it works with the result costs no more than
  /// `candidate` did, or is `candidate` itself, to the bit; in the field, who asks compares the exact risk.
  /// CAND-023 It evaluates the field at most allowance.evaluations times, with allowance.field_work for all, and keeps
  /// within 0.5 m of where it did.
  /// CAND-013 Standing still stays standing still, to the bit.
  /// CAND-014 Within kRefinedAlongM and kRefinedWithinS of it, across within kRefinedInLaneM of the lane's
  /// centre or no further out than it, on its way to a lane within kOnTheWayM of it; and where it kept
  /// its distance from a predicted box, so does the result. It is feasible(), and a
  /// candidate that comes to rest still does: steering, lateral acceleration and the end are bound softly
  /// within, and what oversteps them is dropped.
  /// \param refined  out: the candidate refined, same start \pre not the same object as `candidate`
  [[nodiscard]] RefinementResult refine(const ReferenceLine& line, float start_s_m,
                                        const Surroundings& surroundings, const Parameters& parameters,
                                        RefinementAllowance allowance, const Trajectory& candidate,
                                        Trajectory& refined);

  /// The same of a problem that is stated already. \param origin  what its positions are relative to.
  /// \param problem  out: with the field as last put into it. \param motion  in: the start; out: the best
  [[nodiscard]] RefinementResult improve(const Surroundings& surroundings, const Parameters& parameters,
                                         Point origin, RefinementAllowance allowance,
                                         RefinementProblem& problem, Motion& motion);

  /// Of the last refine() with an allowance.
  [[nodiscard]] const RefinementProblem& problem() const { return problem_; }

 private:
  /// One of the evaluations; without work for it none, and then none is to come.
  [[nodiscard]] bool evaluate(const Surroundings& surroundings, const RefinementProblem& problem,
                              Point origin, const Parameters& parameters, RefinementAllowance allowance,
                              const Motion& motion, RefinementResult& result, FieldAlong& field, float& cost);
  void improve_in_field(const Surroundings& surroundings, const Parameters& parameters, Point origin,
                        RefinementAllowance allowance, RefinementProblem& problem, Motion& motion,
                        RefinementResult& result);
  /// With what is left of the passes. \return whether anything better was found
  [[nodiscard]] bool solve(const RefinementProblem& problem, RefinementAllowance allowance, Motion& motion,
                           RefinementResult& result);

  RefinementProblem problem_;
  Motion motion_;
  Motion best_;
  FieldAlong field_;
  FieldScratch scratch_;
  FieldAlong along_;  ///< along the motion just found
  Ilqr ilqr_;
};

}  // namespace s4tp::trajectory
