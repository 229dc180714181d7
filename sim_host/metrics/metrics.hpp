#pragma once
/// Metrics of an episode, from the recorded state alone (METHOD section 5): the competition evaluator's,
/// exactly as it computes them, and corrected ones in physical units.

#include <cstdint>

#include "sim_host/world/recording.hpp"

namespace s4tp::metrics {

/// The evaluator of the SMARTS 2022 competition. Crash, leaving the road and time-out count alike.
struct Comp1 {
  bool success = false;
  double steps = 0.0;            ///< of 0.1 s to the end; 800 when crashed
  double goal_distance_m = 0.0;  ///< |dx| + |dy| at the last step
  double jerk_linear = 0.0;      ///< mean squared difference of successive acceleration vectors, not over dt
  double jerk_angular = 0.0;     ///< the same of angular acceleration
  double lane_centre_offset = 0.0;  ///< mean of (offset / half lane width)^2
  double obstacle = 0.0;            ///< exp(-0.05 d), last step, nearest within 3 v and 40 degrees ahead
  [[nodiscard]] double time() const { return steps + goal_distance_m; }
  [[nodiscard]] double humanness() const {
    return obstacle + jerk_angular + jerk_linear + lane_centre_offset;
  }
};

struct EpisodeMetrics {
  std::uint64_t seed = 0;
  world::Ending ending = world::Ending::kRunning;
  int redrawn = 0;
  int collisions_at_fault = 0;
  int collisions_other_fault = 0;
  int collisions_competition_box = 0;  ///< with 3.68 x 1.47 m boxes, whoever's fault
  double duration_s = 0.0;             ///< from take-over to the end
  double mean_abs_jerk_mps3 = 0.0;
  double hardest_braking_mps2 = 0.0;  ///< >= 0
  double min_gap_m = 0.0;             ///< between boxes, to anybody; 0 when they touch, large when alone
  double mean_gap_m = 0.0;            ///< to the nearest vehicle ahead in our way; 0 when there never was one
  double min_time_to_collision_s = 0.0;  ///< to the same; large when never closing in
  double rss_violation_share = 0.0;      ///< of the time: nearer to the vehicle ahead than RSS allows
  Comp1 comp1;
};

/// Only what happened after take-over (time >= 0) counts.
[[nodiscard]] EpisodeMetrics evaluate(const world::Recording& recording);

/// \return the word shown for an ending
[[nodiscard]] const char* ending_name(world::Ending ending);

}  // namespace s4tp::metrics
