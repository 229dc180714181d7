#pragma once
/// Distances a lane change keeps in the lane it comes to so that the guard (guard.hpp) passes it, bumper to
/// bumper, at its end: both bounds come from one fail-safe that brakes with 0.8 of guard.braking.

#include "algo/core/parameters.hpp"

namespace s4tp::safety {

inline constexpr float kChangeStandingGapM = 1.0F;  ///< to either, when both stand
inline constexpr float kOverLineS = 0.5F;           ///< until a lane change just begun is over the line

/// Least gap [m] to a leader at `leader_mps` that brakes with law.braking_max.
[[nodiscard]] float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters);

/// Least gap [m] to a follower that brakes with rss b_min, rss rho after we are over the line.
[[nodiscard]] float change_gap_to_follower_m(float own_mps, float follower_mps, const Parameters& parameters);

}  // namespace s4tp::safety
