#pragma once
/// A plan as the guard sees it: the box centre along the path.

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/safety/guard.hpp"

namespace s4tp::safety {

inline constexpr float kHorizonS = static_cast<float>(kHorizonSteps) * kStepS;
inline constexpr float kGoesOnMps2 = 1.5F;  // how a plan is driven on beyond its horizon

/// A plan seen along its path.
struct Guard::Own {
  float s_m[kTrajectoryPoints];  ///< of the box centre
  float speed_mps[kTrajectoryPoints];
  float start_mps2;  ///< acceleration at plan start
  float branch_s_m;  ///< of the box centre, where the fail-safe begins to brake
  float branch_mps;
  float branch_mps2;
  bool blocked;  ///< somebody ahead makes us brake

  [[nodiscard]] float end_s_m() const { return s_m[kHorizonSteps]; }
  [[nodiscard]] float stop_s_m(float braking_mps2) const {
    return branch_s_m + occupancy::braking_way_m(branch_mps, branch_mps2, braking_mps2);
  }
  /// Where the centre stands if braking begins at plan start and builds up from there; and if all of it is there at once:
  /// nothing stops shorter.
  [[nodiscard]] float at_once_s_m(float braking_mps2) const {
    return s_m[0] + occupancy::braking_way_m(speed_mps[0], start_mps2, braking_mps2);
  }
  [[nodiscard]] float nearest_stop_s_m(float braking_mps2) const {
    return s_m[0] + occupancy::stopping_way_m(speed_mps[0], braking_mps2);
  }
  [[nodiscard]] occupancy::Pace beyond(float cap_mps) const {
    const float end_mps = speed_mps[kHorizonSteps];
    return {end_mps, kGoesOnMps2, max(end_mps, cap_mps)};
  }
  /// When the centre comes to `at_s_m`; the plan is driven on beyond its horizon.
  [[nodiscard]] float time_at_s(float at_s_m, float cap_mps) const {
    if (at_s_m > end_s_m())
      return min(occupancy::kNeverS,
                 kHorizonS + occupancy::time_to_cover_s(beyond(cap_mps), at_s_m - end_s_m()));
    int i = 0;
    while (i < kHorizonSteps && s_m[i] < at_s_m) ++i;
    if (i == 0) return 0.0F;
    return (static_cast<float>(i) - (s_m[i] - at_s_m) / (s_m[i] - s_m[i - 1])) * kStepS;
  }
  [[nodiscard]] float speed_at_mps(float time_s, float cap_mps) const {
    if (time_s >= kHorizonS) return occupancy::speed_after_mps(beyond(cap_mps), time_s - kHorizonS);
    return speed_mps[to_int(time_s / kStepS, 0, kHorizonSteps)];
  }
  [[nodiscard]] float place_at_m(float time_s, float cap_mps) const {
    if (time_s >= kHorizonS) return end_s_m() + occupancy::way_after_m(beyond(cap_mps), time_s - kHorizonS);
    return s_m[to_int(time_s / kStepS, 0, kHorizonSteps)];
  }
};

}  // namespace s4tp::safety
