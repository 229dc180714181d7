#include "sim_host/roads/draws.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace s4tp::roads {
namespace {

constexpr double kLeastPerMinute = 5.0;
constexpr double kCrossingPerMinute = 24.0;
constexpr int kCrossingStreams = 4;

}  // namespace

double draw_length_m(traffic::Random& random, double low_m, double high_m) {
  const double share = random.uniform();
  return low_m + (high_m - low_m) * share * share;
}

scenario::Range draw_rate(traffic::Random& random, double most) {
  const double low = random.uniform(kLeastPerMinute, most);
  return {low, random.uniform(low, most)};
}

Streams draw_crossing_streams(traffic::Random& random) {
  Streams streams;
  streams.choose_low = 1;
  streams.choose_high = random.integer(1, kCrossingStreams);
  streams.vehicles_per_minute = draw_rate(random, std::min(20.0, kCrossingPerMinute / streams.choose_high));
  return streams;
}

RoadMission draw_mission(traffic::Random& random) {
  RoadMission mission;
  mission.start_share = random.uniform();
  mission.speed_share = random.uniform(0.6, 1.0);
  mission.entry_time_s = random.uniform(8.0, 20.0);
  return mission;
}

RoadTraffic with_social_drivers(RoadTraffic traffic) {
  traffic.mix = "\"social.toml\"";
  return traffic;
}

std::vector<double> draw_directions(traffic::Random& random, int count, double apart_rad) {
  std::vector<double> directions;
  directions.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    directions.push_back(random.uniform(0.0, 2.0 * std::numbers::pi - count * apart_rad));
  }
  std::sort(directions.begin(), directions.end());
  for (int i = 0; i < count; ++i) {
    directions[static_cast<std::size_t>(i)] += i * apart_rad;
  }
  return directions;
}

map::Vec2 polar(double radius_m, double angle_rad) {
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)};
}

}  // namespace s4tp::roads
