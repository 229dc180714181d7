#include "sim_host/world/adversary/lawful.hpp"

#include <algorithm>

namespace s4tp::adversary {
namespace {

constexpr double kStep_mps2 = 0.25;

struct Motion {
  double way_m = 0.0;
  double speed_mps = 0.0;
};

Motion driven(double speed_mps, double acceleration_mps2, double time_s) {
  const double braking_s =
      acceleration_mps2 < 0.0 ? std::min(time_s, speed_mps / -acceleration_mps2) : time_s;
  return {(speed_mps + 0.5 * acceleration_mps2 * braking_s) * braking_s,
          std::max(0.0, speed_mps + acceleration_mps2 * braking_s)};
}

}  // namespace

bool keeps(const judge::Law& law, const Obstacle& obstacle, double speed_mps, double acceleration_mps2,
           double step_s) {
  const Motion self = driven(speed_mps, acceleration_mps2, step_s);
  const double braking_mps2 = law.rss.front_braking_mps2;
  const Motion other = driven(obstacle.speed_mps, -braking_mps2, step_s);
  const double gap_m = obstacle.gap_m - self.way_m + other.way_m;
  if (obstacle.at_distance) {
    return gap_m >= judge::rss_gap_m(law.rss, self.speed_mps, other.speed_mps);
  }
  const double left_s = std::max(0.0, obstacle.answers_after_s - step_s);
  const double other_stops_m = other.speed_mps * other.speed_mps / (2.0 * braking_mps2);
  return judge::stopping_m(self.speed_mps, left_s, 0.0, self.speed_mps, law.duty_braking_mps2) <=
         gap_m + other_stops_m;
}

double hardest_mps2(const judge::Law& law, std::span<const Obstacle> obstacles, double speed_mps,
                    double most_mps2, double step_s) {
  for (double a = most_mps2; a >= -law.rss.front_braking_mps2; a -= kStep_mps2) {
    if (std::all_of(obstacles.begin(), obstacles.end(),
                    [&](const Obstacle& obstacle) { return keeps(law, obstacle, speed_mps, a, step_s); })) {
      return a;
    }
  }
  return std::min(most_mps2, -law.duty_braking_mps2);
}

}  // namespace s4tp::adversary
