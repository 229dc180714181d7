#pragma once
/// The perception node: what the car's sensors make of the cars around it, as track lists on the bus.

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "firmware/wire/track_list.hpp"
#include "sim_host/world/scenario/perception_preset.hpp"
#include "sim_host/world/traffic/random.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::nodes {

class Perception {
 public:
  /// \param origin  of the odometry frame, network coordinates
  Perception(const scenario::PerceptionOptions& options, map::Vec2 origin, std::uint64_t seed);

  /// WORLD-010 The 16 cars in range that can be near us soonest, the others counted as left out; to be called every
  /// 100 ms.
  void observe(const traffic::CarState& ego, const std::vector<traffic::CarState>& others,
               std::uint32_t vehicle_time_ms);
  /// WORLD-011 Appends a tick's share of the list: at most 12 frames, so that three ticks carry the longest.
  void publish(std::uint32_t vehicle_time_ms, std::vector<wire::Frame>& frames);

 private:
  [[nodiscard]] std::uint8_t wire_id(int car);
  [[nodiscard]] wire::Track track_of(const traffic::CarState& car);
  [[nodiscard]] double noisy(double value, double deviation);

  struct Pending {
    std::uint32_t due_ms = 0;
    wire::Tracks tracks;
  };
  scenario::PerceptionOptions options_;
  map::Vec2 origin_;
  traffic::Random random_;
  std::map<int, std::uint8_t> ids_;  ///< of cars in the last list
  std::uint8_t last_id_ = 0;
  std::deque<Pending> pending_;
  wire::TrackListSender sender_;
};

}  // namespace s4tp::nodes
