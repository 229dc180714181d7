#pragma once
/// Where a free-moving car is on the network.

#include <vector>

#include "sim_host/world/traffic/recording.hpp"
#include "sim_host/world/traffic/traffic_view.hpp"

namespace s4tp::world {

struct LanePlace {
  LaneId lane = kNoLane;  ///< kNoLane: nothing near
  double s_m = 0.0;
  double d_m = 0.0;     ///< left positive
  bool inside = false;  ///< of the lane's strip
};

class Locator {
 public:
  Locator(const Network& network, const RouteGuide& guide);

  /// Lane the car drives on: its centre within the strip, going the lane's way; of several the one it comes
  /// from or goes on to, then its route's. Off every strip: the nearest lane.
  [[nodiscard]] LanePlace locate(Vec2 centre, double heading_rad, LaneId before) const;
  /// WORLD-031 More than half a lane outside every lane, and in no junction's hull.
  [[nodiscard]] bool off_road(Vec2 centre) const;
  /// The ego as other drivers see it, in every lane its box reaches into.
  [[nodiscard]] Actor actor(const CarState& ego, const LanePlace& place) const;

 private:
  struct Bounds {
    Vec2 low;
    Vec2 high;
  };
  [[nodiscard]] bool near(std::size_t lane, Vec2 point, double margin_m) const;
  void add_junction_hulls();

  const Network& network_;
  const RouteGuide& guide_;
  std::vector<Bounds> bounds_;
  std::vector<std::vector<Vec2>> hulls_;  ///< counter-clockwise
};

}  // namespace s4tp::world
