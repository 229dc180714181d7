#pragma once
/// A road for the judge's tests, and drives along it.
///
/// \code
///                        6 north
///                          ^
///   7 <--------------------|----------------   y = 6.4, the other direction (up to x = 100)
///   1 --------------->|    3                   y = 3.2
///   0 --------------->| 2 -+---> 5 east        y = 0; the junction from x = 100 to 120
///         west        |    4 south
/// \endcode
/// Lanes 2 and 3 share a zone: arc lengths 6 to 14 of both, so x = 106 to 114 and y = -4 to 4.

#include <cmath>
#include <functional>
#include <vector>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::test {

/// \param rule  of the one who goes east, beside the one who goes north
inline map::Network judged_road(map::Rule rule) {
  const auto lane = [](const char* edge, int index, std::vector<map::Vec2> points,
                       std::vector<map::LaneId> successors) {
    map::Lane result;
    result.name = std::string(edge) + "_" + std::to_string(index);
    result.edge = edge;
    result.index = index;
    result.centre = map::Polyline(points);
    result.in_junction = edge[0] == ':';
    result.successors = std::move(successors);
    return result;
  };
  map::Network network;
  network.lanes = {lane("west", 0, {{0.0, 0.0}, {100.0, 0.0}}, {2}),
                   lane("west", 1, {{0.0, 3.2}, {100.0, 3.2}}, {}),
                   lane(":x", 0, {{100.0, 0.0}, {120.0, 0.0}}, {5}),
                   lane(":x", 1, {{110.0, -10.0}, {110.0, 10.0}}, {6}),
                   lane("south", 0, {{110.0, -110.0}, {110.0, -10.0}}, {3}),
                   lane("east", 0, {{120.0, 0.0}, {320.0, 0.0}}, {}),
                   lane("north", 0, {{110.0, 10.0}, {110.0, 110.0}}, {}),
                   lane("back", 0, {{100.0, 6.4}, {0.0, 6.4}}, {})};
  network.lanes[0].left = 1;
  network.lanes[1].right = 0;
  network.conflicts = {{2, 3, rule, 6.0, 14.0, 6.0, 14.0}};
  return network;
}

/// The ego's route: from west to the end of east.
inline map::RouteGuide eastwards(const map::Network& network) {
  return {network, {"west", "east"}, 5, 200.0};
}

/// On its way east at x, or north at y; the lane follows from it.
inline traffic::CarState eastbound(int id, double x, double y, double speed_mps) {
  traffic::CarState car;
  car.id = id;
  car.centre = {x, y};
  car.speed_mps = speed_mps;
  car.lane = x > 120.0 ? 5 : x > 100.0 ? 2 : y > 1.6 ? 1 : 0;
  return car;
}
inline traffic::CarState northbound(int id, double y, double speed_mps) {
  traffic::CarState car;
  car.id = id;
  car.centre = {110.0, y};
  car.heading_rad = 2.0 * std::atan(1.0);
  car.speed_mps = speed_mps;
  car.lane = y > 10.0 ? 6 : y > -10.0 ? 3 : 4;
  return car;
}

/// Everybody's state at a time: first the ego's.
using Drive = std::function<std::vector<traffic::CarState>(double)>;

/// What a drive's time 0 is in its snapshots: none of them is of the pre-roll.
inline constexpr double kStart_s = 100.0;

/// Snapshots every 0.1 s from `from_s` to `until_s`, both included.
inline std::vector<traffic::Snapshot> recorded(double from_s, double until_s, const Drive& drive) {
  std::vector<traffic::Snapshot> snapshots;
  const auto count = static_cast<int>(std::lround((until_s - from_s) / 0.1));
  for (int i = 0; i <= count; ++i) {
    traffic::Snapshot snapshot;
    snapshot.time_s = kStart_s + from_s + 0.1 * i;
    std::vector<traffic::CarState> cars = drive(from_s + 0.1 * i);
    snapshot.ego = cars.front();
    snapshot.others.assign(cars.begin() + 1, cars.end());
    snapshots.push_back(snapshot);
  }
  return snapshots;
}

}  // namespace s4tp::test
