#pragma once
/// Episodes put together: rates with intervals, means, percentiles.

#include <map>
#include <string>
#include <vector>

#include "sim_host/metrics/metrics.hpp"

namespace s4tp::metrics {

/// 95 % Wilson score interval of a rate; numbers need not be whole (clusters.hpp).
struct Interval {
  double low = 0.0;
  double high = 1.0;
};
[[nodiscard]] Interval wilson(double successes, double trials);

/// The smallest value that at least `share` of all are not above (nearest rank). \pre values not empty
[[nodiscard]] double percentile(std::vector<double> values, double share);

/// So many of the episodes.
struct Rate {
  int count = 0;
  double share = 0.0;
  Interval interval;
};

struct Summary {
  int episodes = 0;
  Rate success;    ///< reached the goal: no collision at all, whoever's fault
  Rate in_time;    ///< the same, by in_time_s
  Rate collision;  ///< own-size boxes touched, whoever's fault
  Rate at_fault;   ///< the same through our fault
  Rate competition_box_collision;
  Rate off_road;
  Rate time_out;
  Rate dead_ecu;
  Rate hit_standing;                  ///< touched while we stood
  std::map<std::string, int> causes;  ///< of collisions: how many episodes each
  int redrawn = 0;                    ///< draws thrown away
  double in_time_s = 0.0;             ///< of the first episode: those of a cell have the same
  double seconds_to_goal = 0.0;       ///< mean over those that reached it; 0 when none did
  double mean_speed_mps = 0.0;        ///< distance over time, all episodes
  double progress_share = 0.0;        ///< mean
  double mean_abs_jerk_mps3 = 0.0;    ///< mean of the episodes', as all below
  double rms_acceleration_mps2 = 0.0;
  double hardest_braking_mps2 = 0.0;  ///< mean of the episodes' hardest
  double max_lateral_mps2 = 0.0;      ///< mean of the episodes' largest
  double min_gap_m = 0.0;             ///< smallest of all
  double min_ttc_s_p05 = 0.0;         ///< 5th percentile of the episodes' smallest
  double min_ttc_s_median = 0.0;
  // Encounters (encounters.hpp).
  double near_misses = 0.0;           ///< an episode
  Rate close_encroachment;            ///< post-encroachment time below kCloseEncroachment_s
  double imposed_braking_mps2 = 0.0;  ///< mean of the episodes' hardest
  Rate imposed_over_2;
  Rate imposed_over_3;
  Rate pressed;                      ///< time gap below kPressed_s
  double rss_violation_share = 0.0;  ///< of the time
  double rss_violations = 0.0;       ///< an episode
  double comp1_success = 0.0;
  double comp1_time = 0.0;
  double comp1_humanness = 0.0;
};

[[nodiscard]] Summary summarize(const std::vector<EpisodeMetrics>& episodes);

}  // namespace s4tp::metrics
