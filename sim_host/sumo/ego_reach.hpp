#pragma once
/// How much of its lanes the ego's box takes.

#include <vector>

#include "sim_host/world/map/network.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::sumo {

/// Where a car's point is that is `distance_m` ahead of its box centre.
[[nodiscard]] map::Vec2 ahead_of(const traffic::CarState& car, double distance_m);

/// SUMO-006 How long the ego's box is along its lanes: SUMO takes a vehicle for as much of them, behind its front,
/// as it is long, but one that lies across a tight turn reaches further back, and whoever comes behind would
/// drive into the rest.
class EgoReach {
 public:
  explicit EgoReach(const map::Network& network) : network_(network) {}

  /// \param lane where SUMO has its front; kNoLane: on none
  void follow(map::LaneId lane);
  /// From its rear to its front along the lanes that the front came by.
  /// \return at least its length, and at most 5 m more
  [[nodiscard]] double length_m(const traffic::CarState& ego) const;

 private:
  [[nodiscard]] const map::Lane& lane(map::LaneId id) const {
    return network_.lanes[static_cast<std::size_t>(id)];
  }

  const map::Network& network_;
  std::vector<map::LaneId> lanes_;  ///< each leads to the next
};

}  // namespace s4tp::sumo
