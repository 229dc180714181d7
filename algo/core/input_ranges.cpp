#include "algo/core/input_ranges.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {

float limited(float value, const InputRange& range) {
  return clamp(value, range.low, range.high);
}

Track limited(const Track& track) {
  Track result = track;
  result.centre.heading_rad = wrap_angle(track.centre.heading_rad);
  result.speed_mps = limited(track.speed_mps, kTrackSpeedMps);
  result.acceleration_mps2 = limited(track.acceleration_mps2, kTrackAccelerationMps2);
  result.yaw_rate_radps = limited(track.yaw_rate_radps, kTrackYawRateRadps);
  result.length_m = limited(track.length_m, kTrackLengthM);
  result.width_m = limited(track.width_m, kTrackWidthM);
  return result;
}

bool is_taken(float value, const InputRange& range) {
  return is_finite(value) && value >= range.least && value <= range.most;
}

}  // namespace s4tp
