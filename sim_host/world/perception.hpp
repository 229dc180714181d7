#pragma once
/// The perception node: what the car's sensors make of the cars around it, as track lists on the bus.

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "firmware/wire/track_list.hpp"
#include "sim_host/world/random.hpp"
#include "sim_host/world/recording.hpp"

namespace s4tp::world {

/// Imperfections; all off by default (the wire quantises in any case).
struct PerceptionOptions {
  double range_m = 150.0;
  double position_noise_m = 0.0;  ///< standard deviations
  double heading_noise_rad = 0.0;
  double speed_noise_mps = 0.0;
  int latency_ticks = 0;           ///< a list is sent so late, stamped with when it was seen
  double dropout = 0.0;            ///< probability that a car is missing in a list
  double id_switches_per_s = 0.0;  ///< each car's rate of getting a new id
  bool occlusion = false;          ///< cars fully hidden behind others are not seen
};

/// "ideal", "real"
[[nodiscard]] const std::vector<std::string>& perception_names();
/// ideal: nothing of it. real: what a good lidar detector with a tracker behind it does, in orders of
/// magnitude: position errors of 0.15 m a coordinate (car translation error on nuScenes of about 0.2 m), 2
/// degrees of heading, 0.3 m/s of speed (velocity errors there are 0.2 to 0.3 m/s); from sensor to list
/// 100 ms, one sensor period; 2 % of the cars missing in a list, one id switch a car in 100 s; hidden cars
/// unseen. Errors are white: a tracker's are slower and smaller, so this is on the hard side.
/// \throws std::invalid_argument naming those there are
[[nodiscard]] PerceptionOptions perception_preset(const std::string& name);

class Perception {
 public:
  /// \param origin  of the odometry frame, network coordinates
  Perception(const PerceptionOptions& options, Vec2 origin, std::uint64_t seed);

  /// WORLD-010 The nearest 16 cars in range, those beyond counted as left out; to be called every 100 ms.
  void observe(const CarState& ego, const std::vector<CarState>& others, std::uint32_t vehicle_time_ms);
  /// WORLD-011 Appends a tick's share of the list: at most 12 frames, so that three ticks carry the longest.
  void publish(std::uint32_t vehicle_time_ms, std::vector<wire::Frame>& frames);

 private:
  [[nodiscard]] std::uint8_t wire_id(int car);
  [[nodiscard]] wire::Track track_of(const CarState& car);
  [[nodiscard]] double noisy(double value, double deviation);

  struct Pending {
    std::uint32_t due_ms = 0;
    wire::Tracks tracks;
  };
  PerceptionOptions options_;
  Vec2 origin_;
  Random random_;
  std::map<int, std::uint8_t> ids_;  ///< of cars in the last list
  std::uint8_t last_id_ = 0;
  std::deque<Pending> pending_;
  wire::TrackListSender sender_;
};

}  // namespace s4tp::world
