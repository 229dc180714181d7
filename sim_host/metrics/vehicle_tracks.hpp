#pragma once
/// The way of each car through recorded snapshots, as passages of places on lanes.

#include <optional>
#include <span>
#include <vector>

#include "sim_host/world/network.hpp"
#include "sim_host/world/recording.hpp"

namespace s4tp::metrics {

/// Where a box centre was on a lane between two snapshots; both places may lie beyond the lane's ends, on the
/// lanes before and after it.
struct TrackSegment {
  world::LaneId lane = world::kNoLane;
  double from_s = 0.0;  ///< time
  double until_s = 0.0;
  double from_m = 0.0;
  double until_m = 0.0;
};

struct TrackPoint {
  double time_s = 0.0;
  world::LaneId lane = world::kNoLane;
  double s_m = 0.0;
  double speed_mps = 0.0;
};

struct VehicleTrack {
  int id = 0;
  double length_m = 5.0;
  std::vector<TrackPoint> points;
  std::vector<TrackSegment> segments;

  /// First time the box centre is at a place of a lane, between two snapshots in proportion.
  [[nodiscard]] std::optional<double> time_at(world::LaneId lane, double s_m) const;
};

/// \param snapshots  in order of time; the egos in them are left out
[[nodiscard]] std::vector<VehicleTrack> tracks_of(const world::Network& network,
                                                  std::span<const world::Snapshot> snapshots);

}  // namespace s4tp::metrics
