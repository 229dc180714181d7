#include "algo/safety/change_gaps.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"

namespace s4tp::safety {
namespace {

using occupancy::stopping_way_m;

constexpr float kShare = 0.8F;  // of the fail-safe's braking: leaves room ahead and behind alike

}  // namespace

float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters) {
  const auto& guard = parameters.guard;
  const float own_stop_m = own_mps * guard.takeover_s + stopping_way_m(own_mps, kShare * guard.braking_mps2);
  const float its_stop_m = stopping_way_m(leader_mps, parameters.law.braking_max_mps2);
  return kChangeStandingGapM + max(0.0F, own_stop_m - its_stop_m);
}

float change_gap_to_follower_m(float own_mps, float follower_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const auto& guard = parameters.guard;
  const float own_stop_m = own_mps * guard.takeover_s + stopping_way_m(own_mps, kShare * guard.braking_mps2);
  const float its_stop_m =
      follower_mps * (kOverLineS + rss.response_s) + stopping_way_m(follower_mps, rss.braking_min_mps2);
  return kChangeStandingGapM + max(0.0F, its_stop_m - own_stop_m);
}

}  // namespace s4tp::safety
