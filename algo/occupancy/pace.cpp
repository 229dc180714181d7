#include "algo/occupancy/pace.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::occupancy {
namespace {

constexpr float kNoGainMps2 = 1e-3F;  // below this the speed is kept
constexpr float kNoSpeedMps = 1e-3F;

float gaining_time_s(const Pace& pace) {
  const float missing_mps = pace.top_mps - pace.speed_mps;
  if (missing_mps <= 0.0F || pace.gain_mps2 < kNoGainMps2) return 0.0F;
  return missing_mps / pace.gain_mps2;
}

}  // namespace

float speed_after_mps(const Pace& pace, float time_s) {
  return pace.speed_mps + pace.gain_mps2 * min(time_s, gaining_time_s(pace));
}

float way_after_m(const Pace& pace, float time_s) {
  const float gaining_s = min(time_s, gaining_time_s(pace));
  const float reached_mps = pace.speed_mps + pace.gain_mps2 * gaining_s;
  return 0.5F * (pace.speed_mps + reached_mps) * gaining_s + reached_mps * (time_s - gaining_s);
}

float time_to_cover_s(const Pace& pace, float way_m) {
  if (way_m <= 0.0F) return 0.0F;
  const float gaining_s = gaining_time_s(pace);
  const float reached_mps = pace.speed_mps + pace.gain_mps2 * gaining_s;
  const float gaining_m = 0.5F * (pace.speed_mps + reached_mps) * gaining_s;
  if (way_m >= gaining_m) {
    if (reached_mps < kNoSpeedMps) return kNeverS;
    return min(kNeverS, gaining_s + (way_m - gaining_m) / reached_mps);
  }
  return (sqrt(square(pace.speed_mps) + 2.0F * pace.gain_mps2 * way_m) - pace.speed_mps) / pace.gain_mps2;
}

float stopping_way_m(float speed_mps, float braking_mps2) {
  return square(speed_mps) / (2.0F * braking_mps2);
}

float braking_way_m(float speed_mps, float acceleration_mps2, float braking_mps2) {
  const float change_mps2 = acceleration_mps2 + braking_mps2;
  if (change_mps2 <= 0.0F) return stopping_way_m(speed_mps, braking_mps2);
  const float time_s = change_mps2 / kHardJerkMps3;
  const float then_mps = speed_mps + 0.5F * (acceleration_mps2 - braking_mps2) * time_s;
  if (then_mps <= 0.0F) return speed_mps * time_s;  // at rest before
  const float meanwhile_m =
      (speed_mps + (0.5F * acceleration_mps2 - kHardJerkMps3 * time_s / 6.0F) * time_s) * time_s;
  return meanwhile_m + stopping_way_m(then_mps, braking_mps2);
}

float latest_time_s(float speed_mps, float braking_mps2, float way_m) {
  if (way_m <= 0.0F) return 0.0F;
  const float left_m2ps2 = square(speed_mps) - 2.0F * braking_mps2 * way_m;
  if (left_m2ps2 <= 0.0F) return kNeverS;
  return (speed_mps - sqrt(left_m2ps2)) / braking_mps2;
}

}  // namespace s4tp::occupancy
