#pragma once
/// The map node: shows the ECU the lanes within the horizon, as wire records with stable slots.

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "firmware/wire/lane_map.hpp"
#include "sim_host/world/network.hpp"

namespace s4tp::world {

class MapNode {
 public:
  /// \param origin  network coordinates of the odometry frame's origin
  MapNode(const Network& network, const RouteGuide& guide, Vec2 origin, double horizon_m = 150.0);

  /// Chooses the lanes around `position` (network coordinates) and fills the wire map: lanes longer than 12
  /// vertices allow are sent in parts; over 64: route, then conflicting, then neighbours, the rest is
  /// counted.
  const wire::Map& update(Vec2 position);

 private:
  /// A lane as it goes over the wire: the whole of a network lane, or a part of it.
  struct Part {
    LaneId lane = kNoLane;
    double from_m = 0.0;
    double to_m = 0.0;
  };
  const Network& network_;
  const RouteGuide& guide_;
  Vec2 origin_;
  double horizon_m_;
  std::vector<Part> parts_;
  std::vector<wire::Lane> prepared_;
  std::map<int, int> slot_of_part_;
  std::map<int, int> slot_of_conflict_;
  wire::Map map_;
};

}  // namespace s4tp::world
