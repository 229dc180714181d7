#pragma once
/// Distances a lane change keeps in the lane it comes to (TERM-010), bumper to bumper, at its end.

#include "algo/core/inline.hpp"
#include "algo/core/parameters.hpp"
#include "algo/safety/lane_change.hpp"

namespace s4tp {

inline constexpr float kChangeLeaderGapM = 1.0F;    ///< to the leader, when both have stopped
inline constexpr float kChangeFollowerGapM = 2.5F;  ///< to the follower, standing
inline constexpr float kChangeFollowerHeadwayS = 0.3F;

/// Least gap [m] to a leader at `leader_mps` who brakes with rss b_max, when we brake with rss b_min: only
/// there does the proper response (rss.hpp) ask for less. May be negative behind a faster one.
inline float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters) {
  const float own_stop_m = square(own_mps) / (2.0F * parameters.rss.braking_min_mps2);
  const float its_stop_m = square(leader_mps) / (2.0F * parameters.rss.braking_max_mps2);
  return kChangeLeaderGapM + own_stop_m - its_stop_m;
}

/// Least gap [m] to a follower, who need not brake hard then.
inline float change_gap_to_follower_m(float own_mps, float follower_mps) {
  const float braking_m = square(max(0.0F, follower_mps - own_mps)) / (2.0F * kFollowerBrakingMps2);
  return kChangeFollowerGapM + max(kChangeFollowerHeadwayS * follower_mps, braking_m);
}

}  // namespace s4tp
