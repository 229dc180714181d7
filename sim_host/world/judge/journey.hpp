#pragma once
/// The way of each car through recorded snapshots: along which lanes, how far by when.

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::judge {

struct JourneyPoint {
  double time_s = 0.0;
  map::LaneId lane = map::kNoLane;
  double s_m = 0.0;         ///< of the box centre along the lane
  double odometer_m = 0.0;  ///< driven since the first point
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// A lane on the way. Both ends of what is known of it lie a snapshot beyond the lane's own, on the lanes
/// before and after it.
struct Stretch {
  map::LaneId lane = map::kNoLane;
  double start_m = 0.0;  ///< odometer at the lane's start
  double from_m = 0.0;   ///< odometer from where on the car was on it
  double until_m = 0.0;
};

struct Journey {
  int id = 0;
  double length_m = 5.0;
  double width_m = 1.8;
  std::vector<JourneyPoint> points;  ///< in order of time; never empty
  std::vector<Stretch> stretches;    ///< in order, the last ones ahead of where the car was seen last

  /// First time the box centre has driven so far, between two snapshots in proportion; infinity: not seen.
  [[nodiscard]] double time_at(double odometer_m) const;
  [[nodiscard]] std::optional<double> time_at(map::LaneId lane, double s_m) const;
  /// Where on the way a place of a lane lies; none: not on it.
  [[nodiscard]] std::optional<double> odometer_at(map::LaneId lane, double s_m) const;
  /// The last point not after a time. \pre the car was there
  [[nodiscard]] const JourneyPoint& at(double time_s) const;
  [[nodiscard]] bool seen_at(double time_s) const;
};

/// \param snapshots  in order of time; the egos in them are left out, or are the car 0
[[nodiscard]] std::vector<Journey> journeys_of(const map::Network& network,
                                               std::span<const traffic::Snapshot> snapshots,
                                               bool with_ego = false);

/// Goes on beyond where the car was seen last, as far as there is only one way.
/// \param guide  of its route, or null: unknown
void extend(const map::Network& network, const map::RouteGuide* guide, Journey& journey);

}  // namespace s4tp::judge
