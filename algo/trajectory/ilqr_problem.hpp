#pragma once
/// What the optimizer minimizes: squares of what is unpleasant, within bounds, near one candidate
/// (method.md 4.8). Plain data: whoever has it can compute cost and bounds too, and find the optimum by other
/// means.
///
/// \code
///        n ^   . gap to a box: signed distance to the half-plane that separates it from us best
///    across|  /
///   -------o-----> t      reference point of the step, tangent t, normal n; along and across are
///          | along        the deviations of our rear axle from it, across measured from the bent path
/// \endcode
/// Cost of a step = 1/2 sum w r^2 over the residuals r. Positions are relative to the start.

#include <cstdint>

#include "algo/trajectory/ilqr_dynamics.hpp"

namespace s4tp::trajectory {

inline constexpr int kMaxHalfPlanes = 3;  ///< of each step, the nearest

/// Ground we must not touch: n . p <= offset.
struct HalfPlane {
  float normal_x = 0.0F;  ///< unit, from the box towards us
  float normal_y = 0.0F;
  float offset_m = 0.0F;     ///< support of the box along the normal
  float least_gap_m = 0.0F;  ///< that our box has to keep from it
};

/// Root of what the risk field costs at a step, linear about the motion along which it was last evaluated:
/// r = offset + slope . state, and r^2 / 2 is w_r (R + R_0). Weighted already.
struct FieldResidual {
  float offset = 0.0F;
  float by_x = 0.0F;
  float by_y = 0.0F;
  float by_heading = 0.0F;
  float by_speed = 0.0F;
  float by_curvature = 0.0F;
};

/// Weights of the residuals; each step's share, so that a residual of 1 all along costs half the sum.
struct RefinementWeights {
  float jerk = 0.0F;
  float curvature_rate = 0.0F;  ///< of the steering as such
  float lateral_jerk = 0.0F;    ///< of v^2 times curvature rate, v being the reference's
  float lateral = 0.0F;         ///< lateral acceleration
  float along = 0.0F;
  float across = 0.0F;
  float lane = 0.0F;  ///< distance from the lane centre
  float heading = 0.0F;
  float speed = 0.0F;
  float over_cap = 0.0F;   ///< speed over what limit and curves allow
  float clearance = 0.0F;  ///< gap short of comfort_gap_m
  float behind = 0.0F;     ///< linear, per metre that the last step falls behind by more than kBehindBlendM
};

/// Across bound of steps on the way to or from another lane.
inline constexpr float kOnTheWayM = 1.0F;
/// So far behind the cost grows with the square of it, from there on evenly.
inline constexpr float kBehindBlendM = 0.3F;

/// What is wanted of states[i], i = 1 .. kHorizonSteps.
struct RefinementStep {
  MotionState reference;
  float along_x = 1.0F;  ///< unit tangent of the reference
  float along_y = 0.0F;
  float lane_offset_m = 0.0F;  ///< of the reference from the lane centre, left positive
  float speed_cap_mps = 0.0F;
  float along_bound_m = 1.0F;          ///< |along| at most
  float across_low_m = -1.0F;          ///< across at least
  float across_high_m = 1.0F;          ///< and at most
  float curvature_rate_weight = 0.0F;  ///< of the input that leads here, lateral jerk included
  MotionInput input_bound;             ///< |input| at most, of the input that leads here
  int half_plane_count = 0;
  HalfPlane half_planes[kMaxHalfPlanes];
  FieldResidual field;
  float trusted_along_m =
      0.0F;  ///< where the field was evaluated: of the state there, as along and across are
  float trusted_across_m = 0.0F;
};

inline constexpr float kTrustAll = 1e6F;

/// Lagrange multipliers of the bounds of one step, signed: positive at the upper one.
struct BoundMultipliers {
  float along = 0.0F;
  float across = 0.0F;
  float acceleration = 0.0F;
  float curvature = 0.0F;
  float lateral = 0.0F;
  float gap[kMaxHalfPlanes] = {};
};

struct RefinementProblem {
  RefinementWeights weights;
  float end_importance = 1.0F;  ///< factor, at the last step, on the weights that tie us to the reference
  float acceleration_low_mps2 = 0.0F;
  float acceleration_high_mps2 = 0.0F;
  float curvature_bound_1pm = 0.0F;
  float lateral_bound_mps2 = 0.0F;
  float comfort_gap_m = 0.0F;
  float centre_m = 0.0F;  ///< rear axle to the centre of our box
  float half_length_m = 0.0F;
  float half_width_m = 0.0F;
  float trust_m = kTrustAll;    ///< nor further along or across from where the field was evaluated
  float field_constant = 0.0F;  ///< what R_0 adds to the sum of field residuals
  MotionState start;
  RefinementStep steps[kHorizonSteps];  ///< steps[i] is of states[i + 1]
};

/// The start and the references with the inputs between them: what a refinement begins from. Not necessarily
/// an exact motion of the model.
void reference_motion(const RefinementProblem& problem, Motion& motion);

/// The augmented Lagrangian's own part.
struct BoundState {
  float penalty = 0.0F;  ///< 0: bounds are left out
  BoundMultipliers multipliers[kHorizonSteps];
};

/// Cost of a motion, without bounds; and by how much it breaks the worst of them, in units of what matters
/// (BoundUnits in the .cpp): 0 when it keeps all.
struct Judgement {
  float own = 0.0F;    ///< without the field
  float field = 0.0F;  ///< as its residuals have it, R_0 taken off
  [[nodiscard]] float cost() const;
  float violation = 0.0F;
};
[[nodiscard]] Judgement judge_motion(const RefinementProblem& problem, const Motion& motion);

/// Deviation of a state from the step's reference, as its bounds mean it.
struct Deviation {
  float along_m = 0.0F;
  float across_m = 0.0F;  ///< from the bent path, left positive
};
[[nodiscard]] Deviation deviation_of(const RefinementStep& step, const MotionState& state);

/// Cost and the bounds' augmented Lagrangian terms (up to a constant, R_0's included) of inputs[index] and
/// states[index + 1].
[[nodiscard]] float step_merit(const RefinementProblem& problem, const BoundState& bounds, int index,
                               const MotionInput& input, const MotionState& state);

/// One step of the method of multipliers: what the bounds push back with at `motion` becomes their
/// multiplier.
void update_multipliers(const RefinementProblem& problem, const Motion& motion, BoundState& bounds);

}  // namespace s4tp::trajectory
