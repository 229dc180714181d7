#include "sim_host/metrics/summary.hpp"

#include <algorithm>
#include <cmath>

namespace s4tp::metrics {

Interval wilson(int successes, int trials) {
  if (trials == 0) return {};
  constexpr double kZ = 1.959963984540054;  // two-sided 95 %
  const double n = trials;
  const double p = successes / n;
  const double scale = 1.0 + kZ * kZ / n;
  const double centre = (p + kZ * kZ / (2.0 * n)) / scale;
  const double half = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n)) / scale;
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

Summary summarize(const std::vector<EpisodeMetrics>& episodes) {
  Summary sum;
  sum.episodes = static_cast<int>(episodes.size());
  if (episodes.empty()) return sum;
  sum.min_gap_m = episodes.front().min_gap_m;
  std::vector<double> ttc_s;
  for (const EpisodeMetrics& episode : episodes) {
    if (episode.ending == world::Ending::kGoal) {
      ++sum.goals;
      sum.seconds_to_goal += episode.duration_s;
    }
    sum.with_collision += episode.collisions_at_fault + episode.collisions_other_fault > 0;
    sum.with_own_fault += episode.collisions_at_fault > 0;
    sum.with_competition_box_collision += episode.collisions_competition_box > 0;
    sum.off_road += episode.ending == world::Ending::kOffRoad;
    sum.time_out += episode.ending == world::Ending::kTimeOut;
    sum.dead_ecu += episode.ending == world::Ending::kDeadEcu;
    sum.mean_abs_jerk_mps3 += episode.mean_abs_jerk_mps3;
    sum.min_gap_m = std::min(sum.min_gap_m, episode.min_gap_m);
    sum.rss_violation_share += episode.rss_violation_share;
    sum.comp1_time += episode.comp1.time();
    sum.comp1_humanness += episode.comp1.humanness();
    ttc_s.push_back(episode.min_time_to_collision_s);
  }
  const double n = sum.episodes;
  sum.success = wilson(sum.goals, sum.episodes);
  if (sum.goals > 0) sum.seconds_to_goal /= sum.goals;
  sum.mean_abs_jerk_mps3 /= n;
  sum.rss_violation_share /= n;
  sum.comp1_time /= n;
  sum.comp1_humanness /= n;
  const auto middle = ttc_s.begin() + static_cast<std::ptrdiff_t>(ttc_s.size() / 2);
  std::nth_element(ttc_s.begin(), middle, ttc_s.end());
  sum.median_min_ttc_s = *middle;
  return sum;
}

}  // namespace s4tp::metrics
