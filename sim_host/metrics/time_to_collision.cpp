#include "sim_host/metrics/time_to_collision.hpp"

#include <algorithm>
#include <cmath>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::metrics {
namespace {

using map::Vec2;
using traffic::CarState;

constexpr double kSampleS = 0.05;
constexpr double kStraightRadps = 0.01;  // 0.1 m beside the straight line after 10 m at 5 m/s

Vec2 velocity(const CarState& car) {
  return {car.speed_mps * std::cos(car.heading_rad), car.speed_mps * std::sin(car.heading_rad)};
}

bool straight(const CarState& car) {
  return std::abs(car.yaw_rate_radps) < kStraightRadps;
}

/// On an arc of constant speed and yaw rate: the chord leaves halfway between both headings.
CarState after(const CarState& car, double time_s) {
  const double turned = straight(car) ? 0.0 : car.yaw_rate_radps * time_s;
  const double shortened = turned == 0.0 ? 1.0 : std::sin(0.5 * turned) / (0.5 * turned);
  const double chord_m = car.speed_mps * time_s * shortened;
  CarState later = car;
  later.centre.x += chord_m * std::cos(car.heading_rad + 0.5 * turned);
  later.centre.y += chord_m * std::sin(car.heading_rad + 0.5 * turned);
  later.heading_rad += turned;
  return later;
}

}  // namespace

double time_to_collision_s(const CarState& a, const CarState& b, double horizon_s) {
  if (traffic::overlap(traffic::box_of(a), traffic::box_of(b))) return 0.0;
  if (straight(a) && straight(b)) {
    return std::min(horizon_s, traffic::time_to_contact_s(traffic::box_of(a), velocity(a), traffic::box_of(b),
                                                          velocity(b)));
  }
  const double reach_m = 0.5 * (std::hypot(a.length_m, a.width_m) + std::hypot(b.length_m, b.width_m));
  double time_s = kSampleS;
  while (time_s < horizon_s) {
    const CarState then_a = after(a, time_s);
    const CarState then_b = after(b, time_s);
    const double apart_m =
        std::hypot(then_b.centre.x - then_a.centre.x, then_b.centre.y - then_a.centre.y) - reach_m;
    if (apart_m <= 0.0 && traffic::overlap(traffic::box_of(then_a), traffic::box_of(then_b))) return time_s;
    // Nothing can touch sooner than both can come together.
    const double safe_s = std::max(0.0, apart_m) / std::max(a.speed_mps + b.speed_mps, 0.1);
    time_s += std::max(1.0, std::floor(safe_s / kSampleS)) * kSampleS;
  }
  return horizon_s;
}

}  // namespace s4tp::metrics
