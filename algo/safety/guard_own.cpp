#include "algo/safety/guard_own.hpp"

namespace s4tp::safety {

void Guard::Own::find_due(float free_s_m, float braking_mps2) {
  due = 0;
  while (due < kHorizonSteps &&
         s_m[due + 1] + occupancy::stopping_way_m(speed_mps[due + 1], braking_mps2) <= free_s_m)
    ++due;
}

float Guard::Own::time_at_s(float at_s_m, float cap_mps) const {
  if (at_s_m > end_s_m())
    return min(occupancy::kNeverS,
               kHorizonS + occupancy::time_to_cover_s(beyond(cap_mps), at_s_m - end_s_m()));
  int i = 0;
  while (i < kHorizonSteps && s_m[i] < at_s_m) ++i;
  if (i == 0) return 0.0F;
  return (static_cast<float>(i) - (s_m[i] - at_s_m) / (s_m[i] - s_m[i - 1])) * kStepS;
}

float Guard::Own::latest_time_at_s(float at_s_m, float cap_mps, float braking_mps2) const {
  const float time_s = time_at_s(at_s_m, cap_mps);
  if (time_s <= due_s() || due == kHorizonSteps) return time_s;
  return due_s() + occupancy::latest_time_s(speed_mps[due], braking_mps2, at_s_m - s_m[due]);
}

float Guard::Own::speed_at_mps(float time_s, float cap_mps) const {
  if (time_s >= kHorizonS) return occupancy::speed_after_mps(beyond(cap_mps), time_s - kHorizonS);
  return speed_mps[to_int(time_s / kStepS, 0, kHorizonSteps)];
}

float Guard::Own::place_at_m(float time_s, float cap_mps) const {
  if (time_s >= kHorizonS) return end_s_m() + occupancy::way_after_m(beyond(cap_mps), time_s - kHorizonS);
  return s_m[to_int(time_s / kStepS, 0, kHorizonSteps)];
}

}  // namespace s4tp::safety
