#pragma once
/// Draws that the families have in common.

#include <cstddef>
#include <vector>

#include "sim_host/roads/road.hpp"

namespace s4tp::roads {

template <class Value>
[[nodiscard]] const Value& one_of(const std::vector<Value>& values, traffic::Random& random) {
  return values[static_cast<std::size_t>(random.integer(0, static_cast<int>(values.size()) - 1))];
}

/// Short ones often.
[[nodiscard]] double draw_length_m(traffic::Random& random, double low_m, double high_m);

/// Within 5 to 20 vehicles a minute and lane. \param most  of one stream
[[nodiscard]] scenario::Range draw_rate(traffic::Random& random, double most = 20.0);

/// How many streams cross the ego's way, and their rate: together at most 24 vehicles a minute. From 20 on a
/// minor road the mean wait for a gap of 6 s is (exp(2) - 2 - 1) / (1 / 3 s) = 13 s (Adams 1936), from 40 it
/// is 74 s, and no driver reaches the goal in time.
[[nodiscard]] Streams draw_crossing_streams(traffic::Random& random);

/// Entry time, place and speed.
[[nodiscard]] RoadMission draw_mission(traffic::Random& random);

/// The same streams, and drivers by social value orientation.
[[nodiscard]] RoadTraffic with_social_drivers(RoadTraffic traffic);

/// `count` directions [rad], counterclockwise, at least `apart_rad` between neighbours.
[[nodiscard]] std::vector<double> draw_directions(traffic::Random& random, int count, double apart_rad);

[[nodiscard]] map::Vec2 polar(double radius_m, double angle_rad);

}  // namespace s4tp::roads
