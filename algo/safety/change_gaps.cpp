#include "algo/safety/change_gaps.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::safety {

namespace {
constexpr float kShare = 0.8F;  // of the fail-safe's braking: leaves room ahead and behind alike
}  // namespace

float change_gap_to_leader_m(float own_mps, float leader_mps, const Parameters& parameters) {
  const auto& guard = parameters.guard;
  const float own_stop_m =
      own_mps * guard.takeover_s + square(own_mps) / (2.0F * kShare * guard.braking_mps2);
  const float its_stop_m = square(leader_mps) / (2.0F * parameters.law.braking_max_mps2);
  return kChangeStandingGapM + max(0.0F, own_stop_m - its_stop_m);
}

float change_gap_to_follower_m(float own_mps, float follower_mps, const Parameters& parameters) {
  const auto& rss = parameters.rss;
  const auto& guard = parameters.guard;
  const float own_stop_m =
      own_mps * guard.takeover_s + square(own_mps) / (2.0F * kShare * guard.braking_mps2);
  const float its_stop_m =
      follower_mps * (kOverLineS + rss.response_s) + square(follower_mps) / (2.0F * rss.braking_min_mps2);
  return kChangeStandingGapM + max(0.0F, its_stop_m - own_stop_m);
}

}  // namespace s4tp::safety
