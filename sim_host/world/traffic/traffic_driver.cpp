#include "sim_host/world/traffic/traffic_driver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim_host/world/traffic/social_value.hpp"

namespace s4tp::traffic {

Driver draw_driver(const scenario::DriverModel& model, Random& random) {
  Driver driver;
  driver.acceleration_mps2 = model.acceleration_mps2;
  driver.deceleration_mps2 = model.deceleration_mps2;
  driver.emergency_mps2 = random.uniform(model.deceleration_mps2, std::max(model.deceleration_mps2, 9.0));
  driver.headway_s = model.headway_s;
  driver.min_gap_m = std::max(0.5, random.normal(model.min_gap_mean_m, model.min_gap_deviation_m));
  driver.speed_factor =
      std::clamp(random.normal(model.speed_factor_mean, model.speed_factor_deviation), 0.5, 1.5);
  driver.max_speed_mps = model.max_speed_mps;
  driver.imperfection = model.sigma;
  driver.reaction_s = random.uniform(0.5, 1.0);
  driver.lane_keeping = model.lane_keeping;
  const SocialTraits traits = social_traits(model.svo_rad);
  driver.headway_s *= traits.headway;
  driver.min_gap_m *= traits.min_gap;
  driver.acceleration_mps2 *= traits.acceleration;
  driver.speed_factor *= traits.speed;
  driver.gap_margin_s = traits.gap_margin_s;
  driver.patience_s = traits.patience_s;
  driver.politeness = traits.politeness;
  driver.change_threshold_mps2 = traits.change_threshold_mps2;
  driver.asked_braking_mps2 = traits.asked_braking_mps2;
  driver.courtesy = traits.courtesy;
  driver.rivalry = traits.rivalry;
  return driver;
}

double distraction(std::uint64_t seed, int car, double time_s) {
  const std::uint64_t own = next_seed(next_seed(seed ^ 0xD157) + static_cast<std::uint64_t>(car));
  const auto second = static_cast<std::uint64_t>(std::floor(time_s + hash_uniform(own)));
  return hash_uniform(next_seed(own) + second);
}

double free_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps) {
  const double wanted = std::max(wanted_mps, 0.1);
  if (speed_mps <= wanted) {
    return driver.acceleration_mps2 * (1.0 - std::pow(speed_mps / wanted, 4.0));
  }
  const double a = driver.acceleration_mps2;
  const double b = 0.5 * driver.deceleration_mps2;
  return -b * (1.0 - std::pow(wanted / speed_mps, 4.0 * a / b));
}

double following_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps, double gap_m,
                                   double leader_mps) {
  const double free = free_acceleration_mps2(driver, speed_mps, wanted_mps);
  if (!std::isfinite(gap_m)) {
    return free;
  }
  const double a = driver.acceleration_mps2;
  const double comfortable =
      0.6 * driver.deceleration_mps2;  // IDM's b is ordinary braking, SUMO's decel its limit
  const double wanted_gap =
      driver.min_gap_m + std::max(0.0, speed_mps * driver.headway_s + speed_mps * (speed_mps - leader_mps) /
                                                                          (2.0 * std::sqrt(a * comfortable)));
  const double ratio = wanted_gap / std::max(gap_m, 0.1);
  if (speed_mps > std::max(wanted_mps, 0.1)) {
    return ratio >= 1.0 ? free + a * (1.0 - ratio * ratio) : free;
  }
  if (ratio >= 1.0) {
    return a * (1.0 - ratio * ratio);
  }
  return free < 1e-6 ? free : free * (1.0 - std::pow(ratio, 2.0 * a / free));
}

double stopping_acceleration_mps2(const Driver& driver, double speed_mps, double wanted_mps,
                                  double distance_m) {
  Driver stopping = driver;  // a line needs no headway, only a little room
  stopping.min_gap_m = 0.5;
  stopping.headway_s = 0.3;
  return following_acceleration_mps2(stopping, speed_mps, wanted_mps, distance_m, 0.0);
}

double time_to_cover_s(double distance_m, double speed_mps, double acceleration_mps2, double top_mps) {
  if (distance_m <= 0.0) {
    return 0.0;
  }
  const double top = std::max(top_mps, speed_mps);
  if (acceleration_mps2 <= 0.0) {
    return speed_mps > 1e-3 ? distance_m / speed_mps : std::numeric_limits<double>::infinity();
  }
  const double run_up_m = (top * top - speed_mps * speed_mps) / (2.0 * acceleration_mps2);
  if (distance_m <= run_up_m) {
    return (std::sqrt(speed_mps * speed_mps + 2.0 * acceleration_mps2 * distance_m) - speed_mps) /
           acceleration_mps2;
  }
  return (top - speed_mps) / acceleration_mps2 + (distance_m - run_up_m) / std::max(top, 1e-3);
}

double accepted_margin_s(const Driver& driver, double waited_s) {
  const double impatience = std::clamp(waited_s / driver.patience_s, 0.0, 1.0);
  return driver.gap_margin_s * (1.0 - 0.75 * impatience);
}

}  // namespace s4tp::traffic
