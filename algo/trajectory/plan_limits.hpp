#pragma once
/// What every plan of ours keeps to, whatever made it: a plan handed back to us that does not is none of
/// ours.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"

namespace s4tp::trajectory {

inline constexpr float kHardestMps2 = 13.0F;  ///< |acceleration| that any plan may ask for

/// CAND-019 Every value finite and where the arithmetic is good for it: position within 110 km, heading in
/// [-pi, pi], speed 0 .. 100 m/s, acceleration within 13 m/s^2, curvature within 2 / m.
[[nodiscard]] bool in_range(const TrajectoryPoint& point);

/// CAND-020 Every point in range; acceleration within the vehicle's, curvature within what the largest
/// road-wheel angle an ego may have (0.8 rad) steers; points as far apart as their speeds say, speeds as
/// their accelerations allow, headings along the way driven. Each plan the planner makes is one. \note
/// bounded work: two cosines and a sine a point
[[nodiscard]] bool keeps_limits(const Trajectory& trajectory, const Parameters& parameters);

}  // namespace s4tp::trajectory
