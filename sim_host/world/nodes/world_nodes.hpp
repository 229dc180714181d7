#pragma once
/// The world's own nodes on the bus beside the vehicle: perception, map, versions, and the clock.

#include <cstdint>
#include <vector>

#include "firmware/wire/e2e.hpp"
#include "firmware/wire/lane_map.hpp"
#include "sim_host/world/nodes/map_node.hpp"
#include "sim_host/world/nodes/perception.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::nodes {

class WorldNodes {
 public:
  /// \param origin  of the odometry frame, network coordinates  \param seed  of perception's noise
  WorldNodes(const map::Network& network, const map::RouteGuide& guide, map::Vec2 origin,
             const scenario::PerceptionOptions& perception, std::uint64_t seed);

  /// Appends this tick's frames, TICK last. \param now_ms  a multiple of 10
  void publish(std::uint32_t now_ms, const traffic::CarState& ego,
               const std::vector<traffic::CarState>& others, std::vector<wire::Frame>& frames);

 private:
  void publish_map(std::uint32_t now_ms, map::Vec2 ego, std::vector<wire::Frame>& frames);

  map::Vec2 origin_;
  Perception perception_;
  MapNode map_node_;
  wire::MapSender map_sender_;
  wire::E2eSender origin_sender_;
  wire::E2eSender version_sender_;
  wire::E2eSender tick_sender_;
  bool map_shown_ = false;
};

}  // namespace s4tp::nodes
