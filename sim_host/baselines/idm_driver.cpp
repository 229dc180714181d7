#include "sim_host/baselines/idm_driver.hpp"

#include <algorithm>
#include <cmath>

namespace s4tp::baselines {
namespace {

constexpr float kShortestGapM = 0.5F;  // for the model; nearer is touching
constexpr float kGoneFirstS = 0.3F;    // behind somebody who passes first

}  // namespace

float idm_free(const IdmDriver& driver, float speed_mps, float desired_mps) {
  const float ratio = speed_mps / std::max(desired_mps, 0.1F);
  return std::max(driver.acceleration_mps2 * (1.0F - ratio * ratio * ratio * ratio), -driver.braking_mps2);
}

float idm_behind(const IdmDriver& driver, float speed_mps, float gap_m, float leader_mps) {
  const float closing = speed_mps * (speed_mps - leader_mps) /
                        (2.0F * std::sqrt(driver.acceleration_mps2 * driver.braking_mps2));
  const float wanted_m = driver.standstill_gap_m + std::max(0.0F, speed_mps * driver.headway_s + closing);
  const float share = wanted_m / std::max(gap_m, kShortestGapM);
  return driver.acceleration_mps2 * (1.0F - share * share);
}

bool change_accepted(const IdmDriver& driver, float speed_mps, const trajectory::Leader& ahead,
                     const trajectory::Leader& behind) {
  const float least = -driver.asked_braking_mps2;
  const bool ahead_fits =
      ahead.agent < 0 ||
      (ahead.gap_m > kShortestGapM && idm_behind(driver, speed_mps, ahead.gap_m, ahead.speed_mps) > least);
  const bool behind_fits =
      behind.agent < 0 ||
      (behind.gap_m > kShortestGapM && idm_behind(driver, behind.speed_mps, behind.gap_m, speed_mps) > least);
  return ahead_fits && behind_fits;
}

bool gap_accepted(const Crosser& crosser, float in_s, float out_s, float margin_s) {
  if (crosser.gone_s + kGoneFirstS < in_s) return true;
  if (crosser.arrives_s <= 0.0F) return false;
  const bool owes_us = crosser.priority == Priority::kFirstHasPriority ||
                       (crosser.priority == Priority::kFirstCome && crosser.arrives_s > in_s);
  if (owes_us) return crosser.can_stop || crosser.arrives_s > out_s;
  return crosser.arrives_s > out_s + margin_s;
}

}  // namespace s4tp::baselines
