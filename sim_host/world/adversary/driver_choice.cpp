#include "sim_host/world/adversary/driver_choice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "sim_host/world/traffic/random.hpp"

namespace s4tp::adversary {
namespace {

constexpr double kStands_s = 3.0;    // without a reason, no longer ...
constexpr double kDrives_s = 5.0;    // ... then it drives so long
constexpr double kSeesEgo_m = 80.0;  // nobody looks for nearness from further away
constexpr double kHorizon_s = 3.0;
constexpr double kGentle_mps2 = 3.0;
constexpr double kSearching = 0.5;       // share of drivers who look for what comes nearest
constexpr double kShortestMood_s = 0.5;  // of the others; the longest is ...
constexpr double kMoreOfMood_s = 2.0;    // ... so much longer

enum Action { kFull, kRolls, kBrakes, kBrakesHard, kActions };
constexpr double kUpTo[kActions] = {0.5, 0.7, 0.85, 1.0};  // draws that mean each

map::Vec2 place_on(const traffic::RoadIndex& road, const std::vector<traffic::WayPart>& way, double ahead_m) {
  const traffic::WayPart* part = &way.front();
  for (const traffic::WayPart& next : way) {
    if (next.start_m <= ahead_m) part = &next;
  }
  return road.lane(part->lane).centre.at(ahead_m - part->start_m).point;
}

/// How near the ego it comes, if the ego keeps its speed.
double nearest_m(const DriverSituation& at, double acceleration_mps2) {
  const double top_mps = at.law.over_limit * at.road.lane(at.self.lane).speed_limit_mps;
  double nearest = std::numeric_limits<double>::infinity();
  double way_m = 0.0;
  double speed_mps = at.self.speed_mps;
  for (double t = at.step_s; t <= kHorizon_s; t += at.step_s) {
    const double before = speed_mps;
    speed_mps = std::clamp(speed_mps + acceleration_mps2 * at.step_s, 0.0, std::max(top_mps, before));
    way_m += 0.5 * (before + speed_mps) * at.step_s;
    const map::Vec2 own = place_on(at.road, at.self.way, way_m);
    const map::Vec2 ego = place_on(at.road, at.ego.way, at.ego.speed_mps * t);
    nearest = std::min(nearest, std::hypot(own.x - ego.x, own.y - ego.y));
  }
  return nearest;
}

}  // namespace

double chosen_mps2(const DriverSituation& at, double most_mps2, Mood& mood) {
  const double hard = -at.law.rss.front_braking_mps2;
  const double options[kActions] = {most_mps2, std::min(0.0, most_mps2), std::min(-kGentle_mps2, most_mps2),
                                    std::min(hard, most_mps2)};
  if (at.changing) return options[kRolls];
  if (at.stood_s >= kStands_s) mood.drives_until_s = at.time_s + kDrives_s;
  if (at.time_s < mood.drives_until_s) return options[kFull];
  if (traffic::hash_uniform(at.seed) >= kSearching) {
    if (at.time_s >= mood.action_until_s) {
      const double draw = traffic::hash_uniform(traffic::next_seed(at.seed + ++mood.draws));
      mood.action = static_cast<int>(std::upper_bound(std::begin(kUpTo), std::end(kUpTo), draw) - kUpTo);
      mood.action_until_s = at.time_s + kShortestMood_s +
                            kMoreOfMood_s * traffic::hash_uniform(traffic::next_seed(at.seed + ++mood.draws));
    }
    return options[mood.action];
  }
  if (nearest_m(at, most_mps2) > kSeesEgo_m) return most_mps2;
  const double* const best =
      std::min_element(std::begin(options), std::end(options),
                       [&](double a, double b) { return nearest_m(at, a) < nearest_m(at, b) - 1e-3; });
  return *best;
}

}  // namespace s4tp::adversary
