#include "sim_host/metrics/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "sim_host/world/box.hpp"

namespace s4tp::metrics {
namespace {

using world::CarState;
using world::Snapshot;
using world::Vec2;

constexpr double kStepS = 0.1;
constexpr double kCrashSteps = 800.0;
constexpr double kNever = 1e3;

/// `point` in the frame of `car`: x ahead, y left.
Vec2 local(const CarState& car, Vec2 point) {
  const double dx = point.x - car.centre.x;
  const double dy = point.y - car.centre.y;
  const double c = std::cos(car.heading_rad);
  const double s = std::sin(car.heading_rad);
  return {c * dx + s * dy, -s * dx + c * dy};
}

struct Ahead {
  double gap_m = 0.0;
  double closing_mps = 0.0;
  double speed_mps = 0.0;
};

/// The nearest vehicle in the ego's straight way that heads roughly its way.
std::optional<Ahead> ahead_of(const Snapshot& now) {
  std::optional<Ahead> nearest;
  for (const CarState& other : now.others) {
    const Vec2 there = local(now.ego, other.centre);
    const double turn = std::remainder(other.heading_rad - now.ego.heading_rad, 2.0 * std::numbers::pi);
    const bool beside = std::abs(there.y) > (now.ego.width_m + other.width_m) / 2;
    if (there.x < 0 || beside || std::abs(turn) > 1.0) continue;
    const double gap_m = there.x - (now.ego.length_m + other.length_m) / 2;
    const double speed_mps = other.speed_mps * std::cos(turn);
    if (!nearest || gap_m < nearest->gap_m) nearest = Ahead{gap_m, now.ego.speed_mps - speed_mps, speed_mps};
  }
  return nearest;
}

/// RSS definition 1: rho 0.5 s, a_max 2, b_min 5, b_max 8 m/s^2.
double rss_distance_m(double rear_mps, double front_mps) {
  const double reached_mps = rear_mps + 0.5 * 2.0;
  return std::max(0.0, rear_mps * 0.5 + 0.5 * 2.0 * 0.25 + reached_mps * reached_mps / (2.0 * 5.0) -
                           front_mps * front_mps / (2.0 * 8.0));
}

double mean(double sum, int count) {
  return count > 0 ? sum / count : 0.0;
}

Vec2 acceleration_vector(const CarState& car) {
  const double across = car.speed_mps * car.yaw_rate_radps;
  const double c = std::cos(car.heading_rad);
  const double s = std::sin(car.heading_rad);
  return {car.acceleration_mps2 * c - across * s, car.acceleration_mps2 * s + across * c};
}

double obstacle_term(const Snapshot& last) {
  constexpr double kViewRad = 40.0 * std::numbers::pi / 180.0;
  double nearest_m = kNever;
  for (const CarState& other : last.others) {
    const Vec2 there = local(last.ego, other.centre);
    const double distance_m = std::hypot(there.x, there.y);
    const bool in_view = std::abs(std::atan2(there.y, there.x)) <= kViewRad;
    if (in_view && distance_m <= 3.0 * last.ego.speed_mps) nearest_m = std::min(nearest_m, distance_m);
  }
  return nearest_m < kNever ? std::exp(-0.05 * nearest_m) : 0.0;
}

Comp1 comp1_of(const world::Recording& recording, const std::vector<const Snapshot*>& driven) {
  Comp1 result;
  result.success = recording.ending == world::Ending::kGoal;
  result.steps = result.success ? static_cast<double>(driven.size()) : kCrashSteps;
  result.goal_distance_m = recording.goal_distance_m;
  double linear = 0.0;
  double angular = 0.0;
  double offset = 0.0;
  int jerks = 0;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    offset += std::pow(driven[i]->ego_lane_offset_m / (driven[i]->ego_lane_width_m / 2.0), 2);
    if (i < 2) continue;
    const Vec2 before = acceleration_vector(driven[i - 1]->ego);
    const Vec2 now = acceleration_vector(driven[i]->ego);
    linear += std::pow(now.x - before.x, 2) + std::pow(now.y - before.y, 2);
    const double rate = driven[i]->ego.yaw_rate_radps - driven[i - 1]->ego.yaw_rate_radps;
    const double rate_before = driven[i - 1]->ego.yaw_rate_radps - driven[i - 2]->ego.yaw_rate_radps;
    angular += std::pow((rate - rate_before) / kStepS, 2);
    ++jerks;
  }
  result.jerk_linear = mean(linear, jerks);
  result.jerk_angular = mean(angular, jerks);
  result.lane_centre_offset = mean(offset, static_cast<int>(driven.size()));
  if (!driven.empty()) result.obstacle = obstacle_term(*driven.back());
  return result;
}

}  // namespace

EpisodeMetrics evaluate(const world::Recording& recording) {
  std::vector<const Snapshot*> driven;
  for (const Snapshot& snapshot : recording.snapshots) {
    if (snapshot.time_s >= 0.0) driven.push_back(&snapshot);
  }
  EpisodeMetrics result;
  result.seed = recording.seed;
  result.ending = recording.ending;
  result.redrawn = recording.redrawn;
  result.collisions_competition_box = static_cast<int>(recording.collisions_competition.size());
  for (const world::Collision& collision : recording.collisions) {
    const bool ours = collision.fault == world::Fault::kEgo;
    ++(ours ? result.collisions_at_fault : result.collisions_other_fault);
  }
  result.min_gap_m = kNever;
  result.min_time_to_collision_s = kNever;
  double jerk_sum = 0.0;
  double gap_sum = 0.0;
  int leaders = 0;
  int violations = 0;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const Snapshot& now = *driven[i];
    result.duration_s = now.time_s;
    result.hardest_braking_mps2 = std::max(result.hardest_braking_mps2, -now.ego.acceleration_mps2);
    if (i > 0) {
      jerk_sum += std::abs(now.ego.acceleration_mps2 - driven[i - 1]->ego.acceleration_mps2) / kStepS;
    }
    for (const CarState& other : now.others) {
      result.min_gap_m =
          std::min(result.min_gap_m, world::distance_m(world::box_of(now.ego), world::box_of(other)));
    }
    const std::optional<Ahead> ahead = ahead_of(now);
    if (!ahead) continue;
    ++leaders;
    gap_sum += ahead->gap_m;
    if (ahead->closing_mps > 0.1) {
      result.min_time_to_collision_s =
          std::min(result.min_time_to_collision_s, std::max(ahead->gap_m, 0.0) / ahead->closing_mps);
    }
    if (ahead->gap_m < rss_distance_m(now.ego.speed_mps, ahead->speed_mps)) ++violations;
  }
  const int steps = static_cast<int>(driven.size());
  result.mean_abs_jerk_mps3 = mean(jerk_sum, steps - 1);
  result.mean_gap_m = mean(gap_sum, leaders);
  result.rss_violation_share = mean(violations, steps);
  result.comp1 = comp1_of(recording, driven);
  return result;
}

const char* ending_name(world::Ending ending) {
  switch (ending) {
    case world::Ending::kRunning:
      return "running";
    case world::Ending::kGoal:
      return "goal";
    case world::Ending::kCollision:
      return "collision";
    case world::Ending::kOffRoad:
      return "off road";
    case world::Ending::kTimeOut:
      return "time-out";
    case world::Ending::kDeadEcu:
      return "dead ECU";
  }
  return "?";
}

}  // namespace s4tp::metrics
