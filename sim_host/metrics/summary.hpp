#pragma once
/// Episodes put together: rates with intervals, means.

#include <vector>

#include "sim_host/metrics/metrics.hpp"

namespace s4tp::metrics {

/// 95 % Wilson score interval of a rate.
struct Interval {
  double low = 0.0;
  double high = 1.0;
};
[[nodiscard]] Interval wilson(int successes, int trials);

struct Summary {
  int episodes = 0;
  int goals = 0;
  int with_collision = 0;  ///< episodes, whoever's fault
  int with_own_fault = 0;
  int with_competition_box_collision = 0;
  int off_road = 0;
  int time_out = 0;
  int dead_ecu = 0;
  Interval success;
  double seconds_to_goal = 0.0;  ///< mean over those that reached it
  double mean_abs_jerk_mps3 = 0.0;
  double min_gap_m = 0.0;  ///< smallest of all
  double median_min_ttc_s = 0.0;
  double rss_violation_share = 0.0;
  double comp1_time = 0.0;
  double comp1_humanness = 0.0;
};

[[nodiscard]] Summary summarize(const std::vector<EpisodeMetrics>& episodes);

}  // namespace s4tp::metrics
