#pragma once
/// How well the virtual car's sensors see, by name.

#include <string>
#include <vector>

namespace s4tp::scenario {

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

}  // namespace s4tp::scenario
