#pragma once
/// Distances a lane change keeps in the lane it comes to (TERM-010), bumper to bumper, at its end.

#include "algo/core/parameters.hpp"

namespace s4tp {

inline constexpr float kChangeStandingGapM = 1.0F;  ///< to either, when both stand

/// Least gap [m] to a leader at `leader_mps` who brakes with rss b_max, when we brake with rss b_min: only
/// there does the proper response (rss.hpp) ask for less. May be negative behind a faster one.
[[nodiscard]] float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters);

/// Least gap [m] to a follower: a faster one reacts first, and need not brake hard then.
[[nodiscard]] float change_gap_to_follower_m(float own_mps, float follower_mps, const Parameters& parameters);

}  // namespace s4tp
