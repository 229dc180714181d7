#include "sim_host/metrics/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sim_host/metrics/time_to_collision.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

using map::Vec2;
using traffic::CarState;
using traffic::Snapshot;

constexpr double kNobodyM = 1e3;
constexpr double kStandingMps = 0.1;

double mean(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

std::vector<const Snapshot*> driven_part(const traffic::Recording& recording) {
  std::vector<const Snapshot*> driven;
  for (const Snapshot& snapshot : recording.snapshots) {
    if (snapshot.time_s < 0.0) continue;
    // The world goes on for a second after a touch.
    if (!recording.collisions.empty() && snapshot.time_s > recording.collisions.front().time_s + 1e-6 &&
        !driven.empty()) {
      break;
    }
    driven.push_back(&snapshot);
  }
  return driven;
}

void measure_collisions(const traffic::Recording& recording, EpisodeMetrics& result) {
  result.collisions_competition_box = static_cast<int>(recording.collisions_competition.size());
  for (const traffic::Collision& collision : recording.collisions) {
    const bool ours = collision.fault == traffic::Fault::kEgo;
    ++(ours ? result.collisions_at_fault : result.collisions_other_fault);
  }
  const bool touched = recording.ending == traffic::Ending::kCollision && !recording.collisions.empty();
  result.cause =
      touched ? traffic::cause_words(recording.collisions.front().fault, recording.collisions.front().cause)
              : ending_name(recording.ending);
}

void measure_motion(const traffic::Recording& recording, const std::vector<const Snapshot*>& driven,
                    EpisodeMetrics& result) {
  double jerk_sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const CarState& ego = driven[i]->ego;
    squares += ego.acceleration_mps2 * ego.acceleration_mps2;
    result.hardest_braking_mps2 = std::max(result.hardest_braking_mps2, -ego.acceleration_mps2);
    result.max_lateral_mps2 = std::max(result.max_lateral_mps2, std::abs(ego.speed_mps * ego.yaw_rate_radps));
    if (i == 0) continue;
    const CarState& before = driven[i - 1]->ego;
    const double dt_s = driven[i]->time_s - driven[i - 1]->time_s;
    const double jerk_mps3 = std::abs(ego.acceleration_mps2 - before.acceleration_mps2) / dt_s;
    jerk_sum += jerk_mps3;
    result.max_abs_jerk_mps3 = std::max(result.max_abs_jerk_mps3, jerk_mps3);
    result.distance_m += std::hypot(ego.centre.x - before.centre.x, ego.centre.y - before.centre.y);
  }
  result.mean_abs_jerk_mps3 = mean(jerk_sum, driven.empty() ? 0 : driven.size() - 1);
  result.rms_acceleration_mps2 = std::sqrt(mean(squares, driven.size()));
  if (!driven.empty()) {
    result.duration_s = driven.back()->time_s;
    const Vec2 start = driven.front()->ego.centre;
    const double whole_m = std::abs(recording.goal.x - start.x) + std::abs(recording.goal.y - start.y);
    const double left_m = recording.ending == traffic::Ending::kGoal ? 0.0 : recording.goal_distance_m;
    if (whole_m > 0.0) result.progress_share = std::clamp(1.0 - left_m / whole_m, 0.0, 1.0);
  }
}

void measure_distances(const std::vector<const Snapshot*>& driven, EpisodeMetrics& result) {
  result.min_gap_m = kNobodyM;
  for (const Snapshot* const now : driven) {
    for (const CarState& other : now->others) {
      result.min_gap_m =
          std::min(result.min_gap_m, traffic::distance_m(traffic::box_of(now->ego), traffic::box_of(other)));
      result.min_time_to_collision_s =
          std::min(result.min_time_to_collision_s, time_to_collision_s(now->ego, other, kTtcHorizonS));
    }
  }
}

/// What came before take-over is evidence too: who has been ahead for how long.
void measure_encounters(const traffic::Recording& recording, const scenario::Scenario& scenario,
                        const std::vector<const Snapshot*>& driven, EpisodeMetrics& result) {
  if (driven.empty() || scenario.mission.edges.empty()) return;  // of a drive elsewhere no way is known
  const map::RouteGuide guide = mission_guide(scenario);
  const std::span<const Snapshot> upto(
      recording.snapshots.data(), static_cast<std::size_t>(driven.back() - recording.snapshots.data()) + 1);
  result.encounters = encounters_of({}, judge::Evidence(scenario.network, upto, &guide), 0.0);
}

}  // namespace

bool in_time(const EpisodeMetrics& episode) {
  return episode.ending == traffic::Ending::kGoal && episode.duration_s <= episode.in_time_s;
}

EpisodeMetrics evaluate(const traffic::Recording& recording, const scenario::Scenario& scenario) {
  const std::vector<const Snapshot*> driven = driven_part(recording);
  EpisodeMetrics result;
  result.seed = recording.seed;
  result.ending = recording.ending;
  result.redrawn = recording.redrawn;
  result.in_time_s = scenario.mission.in_time_s;
  measure_collisions(recording, result);
  result.collided_standing = recording.ending == traffic::Ending::kCollision && !driven.empty() &&
                             driven.back()->ego.speed_mps < kStandingMps;
  measure_motion(recording, driven, result);
  measure_distances(driven, result);
  measure_encounters(recording, scenario, driven, result);
  result.comp1 = comp1_of(recording, driven);
  return result;
}

}  // namespace s4tp::metrics
