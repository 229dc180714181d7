#pragma once
/// The competition's evaluator (SMARTS 2022), exactly as it computes: what the paper's table is made of.
///
/// A step is 0.1 s; step 0 is the state at take-over and is not counted. Acceleration at step k is the
/// difference of the velocity vectors of k and k - 1 over dt, "jerk" the difference of two such accelerations
/// (not over dt), 0 in the first step. Means run over all steps. Crash, leaving the road and time-out count
/// alike.

#include <vector>

#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::metrics {

struct Comp1 {
  bool success = false;
  double steps = 0.0;               ///< to the end; 800 when crashed
  double goal_distance_m = 0.0;     ///< |dx| + |dy| at the last step
  double jerk_linear = 0.0;         ///< mean squared length of the difference of accelerations [m^2/s^4]
  double jerk_angular = 0.0;        ///< the same of angular accelerations [rad^2/s^4]
  double lane_centre_offset = 0.0;  ///< mean of (offset / half lane width)^2
  double obstacle = 0.0;            ///< exp(-0.05 d), last step, nearest within 3 v and 40 degrees ahead
  [[nodiscard]] double time() const { return steps + goal_distance_m; }
  [[nodiscard]] double humanness() const {
    return obstacle + jerk_angular + jerk_linear + lane_centre_offset;
  }
};

/// \param driven  the recording's snapshots from take-over on, up to what ended the drive
[[nodiscard]] Comp1 comp1_of(const traffic::Recording& recording,
                             const std::vector<const traffic::Snapshot*>& driven);

}  // namespace s4tp::metrics
