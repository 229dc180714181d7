#pragma once
/// How fast a candidate drives: one step of its longitudinal law at a time.

#include "algo/trajectory/candidates.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {

/// Longitudinal state along the reference line.
struct LongitudinalState {
  float s_m = 0.0F;
  float speed_mps = 0.0F;
  float acceleration_mps2 = 0.0F;
};

/// Acceleration the candidate asks for at `time_s` after plan start: its intent, bounded by the speeds that
/// limit and curves allow ahead. CAND-027 Who gains speed faster than is comfortable is as brisk in bends: with
/// kDriveShare of the lateral acceleration that makes a plan infeasible, where that is below the limits along the line.
[[nodiscard]] float wanted_acceleration(const ReferenceLine& line, const Candidate& candidate,
                                        const LongitudinalState& state, float time_s,
                                        const Parameters& parameters);

/// Speed and acceleration one step later: jerk bounded (12 m/s^3 in ordinary driving, 40 in hard braking),
/// the vehicle's limits kept, at rest no acceleration. s_m is left to the caller, who knows the path.
/// \return distance travelled [m] >= 0
[[nodiscard]] float advance(float wanted_mps2, const Parameters& parameters, LongitudinalState& state);

}  // namespace s4tp::trajectory
