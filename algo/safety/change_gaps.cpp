#include "algo/safety/change_gaps.hpp"

#include "algo/core/inline.hpp"
#include "algo/safety/lane_change.hpp"

namespace s4tp {

float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters) {
  const float own_stop_m = square(own_mps) / (2.0F * parameters.rss.braking_min_mps2);
  const float its_stop_m = square(leader_mps) / (2.0F * parameters.rss.braking_max_mps2);
  return kChangeStandingGapM + own_stop_m - its_stop_m;
}

float change_gap_to_follower_m(float own_mps, float follower_mps) {
  const float faster_mps = max(0.0F, follower_mps - own_mps);
  const float closed_m = kFollowerReactionS * faster_mps + square(faster_mps) / (2.0F * kFollowerBrakingMps2);
  return kChangeStandingGapM + max(kChangeFollowerHeadwayS * follower_mps, closed_m);
}

}  // namespace s4tp
