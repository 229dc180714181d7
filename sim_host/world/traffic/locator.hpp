#pragma once
/// Where a free-moving car is on the network.

#include <vector>

#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::traffic {

struct LanePlace {
  map::LaneId lane = map::kNoLane;  ///< kNoLane: nothing near
  double s_m = 0.0;
  double d_m = 0.0;     ///< left positive
  bool inside = false;  ///< of the lane's strip
};

class Locator {
 public:
  Locator(const map::Network& network, const map::RouteGuide& guide);

  /// Lane the car drives on: its centre within the strip, going the lane's way; of several the one it comes
  /// from or goes on to, then its route's. Off every strip: the nearest lane.
  [[nodiscard]] LanePlace locate(map::Vec2 centre, double heading_rad, map::LaneId before) const;
  /// WORLD-031 More than half a lane outside every lane, and in no junction's hull.
  [[nodiscard]] bool off_road(map::Vec2 centre) const;
  /// The ego as other drivers see it, in every lane its box reaches into.
  [[nodiscard]] Actor actor(const CarState& ego, const LanePlace& place) const;

 private:
  struct Bounds {
    map::Vec2 low;
    map::Vec2 high;
  };
  [[nodiscard]] bool near(std::size_t lane, map::Vec2 point, double margin_m) const;
  void add_junction_hulls();

  const map::Network& network_;
  const map::RouteGuide& guide_;
  std::vector<Bounds> bounds_;
  std::vector<std::vector<map::Vec2>> hulls_;  ///< counter-clockwise
};

}  // namespace s4tp::traffic
