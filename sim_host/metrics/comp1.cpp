#include "sim_host/metrics/comp1.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

using map::Vec2;
using traffic::CarState;
using traffic::Snapshot;

constexpr double kCrashSteps = 800.0;

Vec2 velocity(const CarState& car) {
  return {car.speed_mps * std::cos(car.heading_rad), car.speed_mps * std::sin(car.heading_rad)};
}

struct Acceleration {
  Vec2 linear;
  double angular = 0.0;
};

Acceleration acceleration(const Snapshot& before, const Snapshot& now) {
  const double dt_s = now.time_s - before.time_s;
  const Vec2 v0 = velocity(before.ego);
  const Vec2 v1 = velocity(now.ego);
  return {{(v1.x - v0.x) / dt_s, (v1.y - v0.y) / dt_s},
          (now.ego.yaw_rate_radps - before.ego.yaw_rate_radps) / dt_s};
}

double obstacle_term(const Snapshot& last) {
  constexpr double kViewRad = 40.0 * std::numbers::pi / 180.0;
  std::optional<double> nearest_m;
  for (const CarState& other : last.others) {
    const double dx = other.centre.x - last.ego.centre.x;
    const double dy = other.centre.y - last.ego.centre.y;
    const double distance_m = std::hypot(dx, dy);
    const double angle = map::wrap_angle(std::atan2(dy, dx) - last.ego.heading_rad);
    if (std::abs(angle) > kViewRad || distance_m > 3.0 * last.ego.speed_mps) continue;
    nearest_m = std::min(nearest_m.value_or(distance_m), distance_m);
  }
  return nearest_m ? std::exp(-0.05 * *nearest_m) : 0.0;
}

}  // namespace

Comp1 comp1_of(const traffic::Recording& recording, const std::vector<const Snapshot*>& driven) {
  Comp1 result;
  result.success = recording.ending == traffic::Ending::kGoal;
  result.goal_distance_m = recording.goal_distance_m;
  result.steps = kCrashSteps;
  if (driven.size() < 2) return result;
  const std::size_t steps = driven.size() - 1;
  if (result.success) result.steps = static_cast<double>(steps);
  for (std::size_t k = 1; k <= steps; ++k) {
    const Snapshot& now = *driven[k];
    result.lane_centre_offset += std::pow(now.ego_lane_offset_m / (now.ego_lane_width_m / 2.0), 2);
    if (k == 1) continue;
    const Acceleration a0 = acceleration(*driven[k - 2], *driven[k - 1]);
    const Acceleration a1 = acceleration(*driven[k - 1], now);
    result.jerk_linear += std::pow(a1.linear.x - a0.linear.x, 2) + std::pow(a1.linear.y - a0.linear.y, 2);
    result.jerk_angular += std::pow(a1.angular - a0.angular, 2);
  }
  const double n = static_cast<double>(steps);
  result.lane_centre_offset /= n;
  result.jerk_linear /= n;
  result.jerk_angular /= n;
  result.obstacle = obstacle_term(*driven.back());
  return result;
}

}  // namespace s4tp::metrics
