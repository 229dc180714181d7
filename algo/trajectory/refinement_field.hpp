#pragma once
/// The risk field in the optimizer (method.md 4.8): evaluated on a motion at every third step, linear between, as
/// one residual a step. Covering (a place never costs twice) counts as fixed where it is evaluated.
///
/// \code
///   w R(t)     o           w = w_r dt, R with both sides and the excess over C_t, made smooth
///            /   '-o       o: evaluated, with its slope by the state (pose, speed, curvature)
///          o        '-o    r = sqrt(2 w (R + R_0)), linear about the motion: r^2 / 2 is w (R + R_0)
///   -------------------------> t
/// \endcode

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/sadrf/risk.hpp"
#include "algo/trajectory/clearance.hpp"
#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::trajectory {

inline constexpr int kFieldStride = 3;  ///< steps from one place evaluated to the next
inline constexpr int kFieldKnots = kHorizonSteps / kFieldStride;  ///< the last one is the last step
static_assert(kHorizonSteps % kFieldStride == 0);

/// The field at one step: R, and its slopes along and across the reference there.
struct FieldKnot {
  float risk = 0.0F;
  float by_along = 0.0F;
  float by_across = 0.0F;
  float by_heading = 0.0F;
  float by_speed = 0.0F;
  float by_curvature = 0.0F;
};

/// Of an evaluation that looks at no knot [WorkMeter's units].
inline constexpr std::int32_t kLeastFieldWork = 180;

struct FieldAlong {
  FieldKnot knots[kFieldKnots];  ///< of steps[kFieldStride - 1], ...
};

/// Working memory of evaluate_field; nothing in it outlives the call.
struct FieldScratch {
  Trajectory trajectory;
  sadrf::SmoothRisk risks[kHorizonSteps];
};

/// CAND-022 Evaluates the field along a motion, with its slopes by pose, speed and curvature. \param origin  what
/// the problem's positions are relative to \return w_r times the integral of R, linear between the knots; 0:
/// there is no risk \param work  where it does not allow more, knots are as sadrf::smooth_risk leaves them
[[nodiscard]] float evaluate_field(const Surroundings& surroundings, const RefinementProblem& problem,
                                   Point origin, const Motion& motion, const Parameters& parameters,
                                   WorkMeter& work, FieldScratch& scratch, FieldAlong& field);

/// Takes the field out of a problem again.
void without_field(RefinementProblem& problem);

/// On the way to or from another lane the field has no say across: the decision stands.
/// Makes `field`, evaluated along `motion`, the problem's residuals, trusted within `trust_m` of it.
void put_field(const FieldAlong& field, const Motion& motion, float trust_m, const Parameters& parameters,
               RefinementProblem& problem);

}  // namespace s4tp::trajectory
