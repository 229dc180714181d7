#include "sim_host/metrics/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim_host/metrics/confidence.hpp"

namespace s4tp::metrics {

Interval wilson(double successes, double trials) {
  if (trials <= 0.0) return {};
  const double n = trials;
  const double p = successes / n;
  const double scale = 1.0 + kZ * kZ / n;
  const double centre = (p + kZ * kZ / (2.0 * n)) / scale;
  const double half = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n)) / scale;
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

double percentile(std::vector<double> values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  const std::ptrdiff_t index = std::max(static_cast<std::ptrdiff_t>(rank) - 1, std::ptrdiff_t{0});
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

Summary summarize(const std::vector<EpisodeMetrics>& episodes) {
  using traffic::Ending;
  Summary sum;
  sum.episodes = static_cast<int>(episodes.size());
  if (episodes.empty()) return sum;
  const auto rate = [&](const auto& holds) {
    const int count = static_cast<int>(std::count_if(episodes.begin(), episodes.end(), holds));
    return Rate{count, static_cast<double>(count) / sum.episodes, wilson(count, sum.episodes)};
  };
  const auto ended = [&](Ending ending) {
    return rate([ending](const EpisodeMetrics& episode) { return episode.ending == ending; });
  };
  const auto mean = [&](const auto& value) {
    double total = 0.0;
    for (const EpisodeMetrics& episode : episodes) total += value(episode);
    return total / sum.episodes;
  };
  sum.success = ended(Ending::kGoal);
  sum.in_time = rate(in_time);
  sum.in_time_s = episodes.front().in_time_s;
  sum.collision = rate([](const auto& e) { return e.collisions_at_fault + e.collisions_other_fault > 0; });
  sum.at_fault = rate([](const auto& e) { return e.collisions_at_fault > 0; });
  sum.competition_box_collision = rate([](const auto& e) { return e.collisions_competition_box > 0; });
  sum.off_road = ended(Ending::kOffRoad);
  sum.time_out = ended(Ending::kTimeOut);
  sum.dead_ecu = ended(Ending::kDeadEcu);
  sum.hit_standing = rate([](const auto& e) { return e.collided_standing; });

  std::vector<double> ttc_s;
  double goal_s = 0.0;
  double time_s = 0.0;
  double distance_m = 0.0;
  sum.min_gap_m = episodes.front().min_gap_m;
  for (const EpisodeMetrics& episode : episodes) {
    sum.redrawn += episode.redrawn;
    sum.min_gap_m = std::min(sum.min_gap_m, episode.min_gap_m);
    time_s += episode.duration_s;
    distance_m += episode.distance_m;
    ttc_s.push_back(episode.min_time_to_collision_s);
    if (episode.ending == Ending::kGoal) goal_s += episode.duration_s;
    if (episode.ending == Ending::kCollision) ++sum.causes[episode.cause];
  }
  if (sum.success.count > 0) sum.seconds_to_goal = goal_s / sum.success.count;
  if (time_s > 0.0) sum.mean_speed_mps = distance_m / time_s;
  sum.min_ttc_s_p05 = percentile(ttc_s, 0.05);
  sum.min_ttc_s_median = percentile(ttc_s, 0.5);
  sum.progress_share = mean([](const auto& e) { return e.progress_share; });
  sum.mean_abs_jerk_mps3 = mean([](const auto& e) { return e.mean_abs_jerk_mps3; });
  sum.rms_acceleration_mps2 = mean([](const auto& e) { return e.rms_acceleration_mps2; });
  sum.hardest_braking_mps2 = mean([](const auto& e) { return e.hardest_braking_mps2; });
  sum.max_lateral_mps2 = mean([](const auto& e) { return e.max_lateral_mps2; });
  sum.near_misses = mean([](const auto& e) { return e.encounters.near_misses; });
  sum.close_encroachment =
      rate([](const auto& e) { return e.encounters.min_post_encroachment_s < kCloseEncroachment_s; });
  sum.imposed_braking_mps2 = mean([](const auto& e) { return e.encounters.imposed_braking_mps2; });
  sum.imposed_over_2 = rate([](const auto& e) { return e.encounters.imposed_braking_mps2 > 2.0; });
  sum.imposed_over_3 = rate([](const auto& e) { return e.encounters.imposed_braking_mps2 > 3.0; });
  sum.pressed = rate([](const auto& e) { return e.encounters.min_time_gap_s < kPressed_s; });
  sum.rss_violation_share = mean([](const auto& e) { return e.encounters.rss_violation_share; });
  sum.rss_violations = mean([](const auto& e) { return e.encounters.rss_violations; });
  sum.comp1_success = mean([](const auto& e) { return e.comp1.success ? 1.0 : 0.0; });
  sum.comp1_time = mean([](const auto& e) { return e.comp1.time(); });
  sum.comp1_humanness = mean([](const auto& e) { return e.comp1.humanness(); });
  return sum;
}

}  // namespace s4tp::metrics
