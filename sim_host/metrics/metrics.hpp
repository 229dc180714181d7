#pragma once
/// Metrics of an episode in physical units, from the recorded state alone, never from a planner's opinion
/// (METHOD section 5); the competition's own beside them (comp1.hpp).

#include <cstdint>
#include <string>

#include "sim_host/metrics/comp1.hpp"
#include "sim_host/world/recording.hpp"

namespace s4tp::metrics {

/// Who keeps his distance comes no nearer than this in time; a car met nearer, but not touched, is a near
/// miss. Source: Gettman and Head 2003, surrogate safety measures (the usual limit in traffic engineering).
inline constexpr double kNearMissTtcS = 1.5;
/// Times to collision beyond this are nobody's concern and count as this.
inline constexpr double kTtcHorizonS = 10.0;

struct EpisodeMetrics {
  std::uint64_t seed = 0;
  world::Ending ending = world::Ending::kRunning;
  int redrawn = 0;
  // Collisions: all that touched at the same instant; the first one's cause.
  int collisions_at_fault = 0;
  int collisions_other_fault = 0;
  int collisions_competition_box = 0;  ///< with 3.68 x 1.47 m boxes, whoever's fault
  bool collided_standing = false;      ///< we stood (below 0.1 m/s) when touched
  std::string cause;                   ///< of the first collision (attribution.hpp); else the ending in words
  // How far and how fast.
  double duration_s = 0.0;      ///< from take-over to the end, or to the first touch
  double distance_m = 0.0;      ///< driven
  double progress_share = 0.0;  ///< of the Manhattan distance to the goal covered; 1: all of it
  // Comfort.
  double mean_abs_jerk_mps3 = 0.0;  ///< along the car
  double max_abs_jerk_mps3 = 0.0;
  double rms_acceleration_mps2 = 0.0;  ///< along the car
  double hardest_braking_mps2 = 0.0;   ///< >= 0
  double max_lateral_mps2 = 0.0;       ///< |v * yaw rate|
  // Distance kept.
  double min_gap_m = 0.0;   ///< between boxes, to anybody; 0 when they touch, 1000 when alone
  double mean_gap_m = 0.0;  ///< to the nearest vehicle ahead in our way; 0 when there never was one
  /// Smallest time until boxes touch when both keep speed and yaw rate, to anybody; at most kTtcHorizonS.
  double min_time_to_collision_s = kTtcHorizonS;
  int near_misses = 0;               ///< cars met with less than kNearMissTtcS and not touched
  double rss_violation_share = 0.0;  ///< of the time: nearer to the vehicle ahead than RSS allows
  int rss_violations = 0;            ///< how many times that began
  Comp1 comp1;
};

/// Only what happened after take-over (time >= 0) counts, and nothing after the first touch.
[[nodiscard]] EpisodeMetrics evaluate(const world::Recording& recording);

/// RSS definition 1, the least gap of a follower: rho 0.5 s, a_max 2, b_min 5, b_max 8 m/s^2.
[[nodiscard]] double rss_distance_m(double rear_mps, double front_mps);

/// \return the word shown for an ending
[[nodiscard]] const char* ending_name(world::Ending ending);
/// \throws std::invalid_argument for a word ending_name() never gives
[[nodiscard]] world::Ending ending_of(const std::string& name);

}  // namespace s4tp::metrics
