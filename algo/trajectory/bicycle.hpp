#pragma once
/// Kinematic bicycle: the motion model of plans, predictions of ourselves and the minimum-risk manoeuvre.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"

namespace s4tp::trajectory {

/// One midpoint step of `duration_s` at constant acceleration and curvature rate; speed stops at 0, and at
/// rest the pose stays as it is, bit for bit (CAND-001). On a constant curvature k the path closes after
/// 2 pi / k (CAND-002).
[[nodiscard]] TrajectoryPoint bicycle_step(const TrajectoryPoint& state, float acceleration_mps2,
                                           float curvature_rate_1pms, float duration_s);

/// Road-wheel angle for a path curvature and back.
[[nodiscard]] float steering_for(float curvature_1pm, float wheelbase_m);
[[nodiscard]] float curvature_for(float steering_rad, float wheelbase_m);

/// Our box when the rear axle stands at `rear_axle`.
[[nodiscard]] Box ego_box(const Pose& rear_axle, const Parameters& parameters);
/// Distance from the rear axle to the box centre, and to the front bumper [m].
[[nodiscard]] float rear_axle_to_centre_m(const Parameters& parameters);
[[nodiscard]] float rear_axle_to_front_m(const Parameters& parameters);

/// Whether points lie as far apart as their speeds say: beyond a line's centre of curvature, a path that
/// keeps its distance from the line does not (CAND-012).
[[nodiscard]] bool as_far_as_driven(const Trajectory& trajectory);

/// Lateral acceleration, steering angle (hence curvature) and rate, acceleration within the vehicle's limits
/// (CAND-003), and as far as driven. A limit that points[0] itself violates is widened
/// to that value: the past never makes every motion infeasible (CAND-004).
[[nodiscard]] bool feasible(const Trajectory& trajectory, const Parameters& parameters);

}  // namespace s4tp::trajectory
