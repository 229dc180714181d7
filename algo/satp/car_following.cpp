#include "algo/satp/car_following.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::satp {
namespace {

constexpr float kTwoSqrtAB = 4.472136F;  // 2 sqrt(a b), b = 2.5 m/s^2
constexpr float kFreeBrakingMps2 = 3.0F;
constexpr float kWishToStandMps = 0.1F;  // who wants less than this wants to stand
constexpr float kShortestGapM = 0.5F;
constexpr float kShortestHeadwayS = 0.4F;

}  // namespace

float free_acceleration(float speed_mps, float desired_mps) {
  if (desired_mps < kWishToStandMps) return -kFreeBrakingMps2;
  const float ratio = square(speed_mps / desired_mps);
  return max(kAccelerationMps2 * (1.0F - ratio * ratio), -kFreeBrakingMps2);
}

float following_acceleration(float speed_mps, float gap_m, float leader_mps, float headway_s) {
  const float approach = speed_mps * (speed_mps - leader_mps) / kTwoSqrtAB;
  const float wanted_m = kStandstillGapM + max(speed_mps * headway_s + approach, 0.0F);
  return kAccelerationMps2 * (1.0F - square(wanted_m / max(gap_m, kShortestGapM)));
}

float kept_headway_s(float gap_m, float speed_mps) {
  return clamp((gap_m - kStandstillGapM) / max(speed_mps, 1.0F), kShortestHeadwayS, kUsualHeadwayS);
}

}  // namespace s4tp::satp
