#pragma once
/// A plan as the guard sees it: the box centre along the path.

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/safety/guard.hpp"

namespace s4tp::safety {

inline constexpr float kEasesOff = 0.25F;  // share of the fail-safe's braking not asked for behind a cut-in
inline constexpr float kRoundingM = 0.01F;
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
  int due;       ///< step at which braking is due at the latest for who is ahead; kHorizonSteps: it is not

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
  /// How far the fail-safe of a plan reaches that brakes like it from plan start on, but for a share.
  [[nodiscard]] float braked_stop_s_m(const Parameters& parameters) const {
    const auto& guard = parameters.guard;
    const float at_once_m = at_once_s_m(guard.braking_mps2);
    return lerp(at_once_m, at_once_m + speed_mps[0] * guard.takeover_s, kEasesOff) + kRoundingM;
  }
  [[nodiscard]] occupancy::Pace beyond(float cap_mps) const {
    const float end_mps = speed_mps[kHorizonSteps];
    return {end_mps, kGoesOnMps2, max(end_mps, cap_mps)};
  }
  [[nodiscard]] float due_s() const { return static_cast<float>(due) * kStepS; }
  /// Sets `due`: braking from then on still ends at `free_s_m`.
  void find_due(float free_s_m, float braking_mps2);
  /// When the centre comes to `at_s_m`; the plan is driven on beyond its horizon.
  [[nodiscard]] float time_at_s(float at_s_m, float cap_mps) const;
  /// The same if it brakes once that is due.
  [[nodiscard]] float latest_time_at_s(float at_s_m, float cap_mps, float braking_mps2) const;
  [[nodiscard]] float speed_at_mps(float time_s, float cap_mps) const;
  [[nodiscard]] float place_at_m(float time_s, float cap_mps) const;
};

}  // namespace s4tp::safety
