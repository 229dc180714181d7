#pragma once
/// Metrics of an episode in physical units, from the recorded state alone, never from a planner's opinion
/// (method.md 5); the competition's own beside them (comp1.hpp).

#include <cstdint>
#include <string>

#include "sim_host/metrics/comp1.hpp"
#include "sim_host/metrics/encounters.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::metrics {

/// Times to collision beyond this are nobody's concern and count as this.
inline constexpr double kTtcHorizonS = 10.0;

struct EpisodeMetrics {
  std::uint64_t seed = 0;
  traffic::Ending ending = traffic::Ending::kRunning;
  int redrawn = 0;
  // Collisions: all that touched at the same instant; the first one's cause.
  int collisions_at_fault = 0;
  int collisions_other_fault = 0;
  int collisions_competition_box = 0;  ///< with 3.68 x 1.47 m boxes, whoever's fault
  bool collided_standing = false;      ///< we stood (below 0.1 m/s) when touched
  std::string cause;                   ///< of the first collision (attribution.hpp); else the ending in words
  // How far and how fast.
  double duration_s = 0.0;      ///< from take-over to the end, or to the first touch
  double in_time_s = 0.0;       ///< by when a goal counts as in time; the scenario's
  double distance_m = 0.0;      ///< driven
  double progress_share = 0.0;  ///< of the Manhattan distance to the goal covered; 1: all of it
  // Comfort.
  double mean_abs_jerk_mps3 = 0.0;  ///< along the car
  double max_abs_jerk_mps3 = 0.0;
  double rms_acceleration_mps2 = 0.0;  ///< along the car
  double hardest_braking_mps2 = 0.0;   ///< >= 0
  double max_lateral_mps2 = 0.0;       ///< |v * yaw rate|
  // Distance kept.
  double min_gap_m = 0.0;  ///< between boxes, to anybody; 0 when they touch, 1000 when alone
  /// Smallest time until boxes touch when both keep speed and yaw rate, to anybody; at most kTtcHorizonS.
  double min_time_to_collision_s = kTtcHorizonS;
  Encounters encounters;
  Comp1 comp1;
};

/// Whether the goal was reached by in_time_s.
[[nodiscard]] bool in_time(const EpisodeMetrics& episode);

/// Only what happened after take-over (time >= 0) counts, and nothing after the first touch.
[[nodiscard]] EpisodeMetrics evaluate(const traffic::Recording& recording,
                                      const scenario::Scenario& scenario);

/// \return the word shown for an ending
[[nodiscard]] const char* ending_name(traffic::Ending ending);
/// \throws std::invalid_argument for a word ending_name() never gives
[[nodiscard]] traffic::Ending ending_of(const std::string& name);

}  // namespace s4tp::metrics
