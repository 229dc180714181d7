#include "algo/trajectory/speed_profile.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/occupancy/safe_distance.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kReactS = 0.6F;          // a cap is approached exponentially with this time constant
constexpr float kCapBrakingMps2 = 5.0F;  // no more than this for a limit or curve
constexpr float kBegin = 0.8F;           // share of comfortable braking at which a stop begins
constexpr float kShortM = 0.15F;         // stops aim this much short: the last step may overshoot a little
constexpr float kLeastAimM = 0.1F;       // no division by less
constexpr float kHoldMps = 0.15F;        // slower than this and near the target: come to rest
constexpr float kHoldM = 0.5F;
constexpr float kRestMps2 = 1.0F;        // braking of the last crawl
constexpr float kSettleS = 0.8F;         // a gap's place is settled at exponentially with this
constexpr float kFollowGapM = 0.5F;      // beyond the RSS distance: clipping stays rare
constexpr float kDriveJerkMps3 = 8.0F;   // building up drive
constexpr float kBrakeJerkMps3 = 12.0F;  // ordinary braking and its release
constexpr float kHardMps2 = -3.5F;       // braking harder builds up with kHardJerkMps3

/// Acceleration that meets the speed cap kReactS ahead. Who is brisk is so in bends, too, until they end.
float for_cap(const ReferenceLine& line, const LongitudinalState& state, bool brisk,
              const Parameters& parameters) {
  const auto& comfort = parameters.comfort;
  float cap_mps = speed_cap_at(line, state.s_m + kReactS * state.speed_mps);
  if (brisk) {
    const float bend_mps = min(cap_mps, speed_cap_at(line, state.s_m));
    const float faster = sqrt(max(1.0F, kDriveShare * comfort.lateral_max_mps2 / comfort.lateral_mps2));
    cap_mps = max(bend_mps, min(faster * bend_mps, line.slowest_limit_mps));
  }
  return max(-kCapBrakingMps2, (cap_mps - state.speed_mps) / kReactS);
}

/// Braking that ends at the target: gentle as long as gentle is enough, and then exactly as hard as needed.
float for_stop(float left_m, float speed_mps, float braking_mps2) {
  if (speed_mps < kHoldMps && left_m < kHoldM) return -kRestMps2;
  const float aim_m = left_m - kShortM;
  const float needed_mps2 = square(speed_mps) / (2.0F * max(aim_m, kLeastAimM));
  if (needed_mps2 > kBegin * braking_mps2) return -needed_mps2;
  const float room_m = max(0.0F, aim_m - kReactS * speed_mps);
  return (sqrt(2.0F * kBegin * braking_mps2 * room_m) - speed_mps) / kReactS;
}

/// Car-following as in the intelligent driver model, its wanted gap never below the RSS distance.
float for_leader(float gap_m, float speed_mps, float leader_mps, const Parameters& parameters) {
  const auto& comfort = parameters.comfort;
  const float closing =
      speed_mps * (speed_mps - leader_mps) / (2.0F * sqrt(comfort.acceleration_mps2 * comfort.braking_mps2));
  const float idm_m = comfort.standstill_gap_m + max(0.0F, comfort.headway_s * speed_mps + closing);
  const float wanted_m =
      max(idm_m, occupancy::safe_distance_m(speed_mps, leader_mps, parameters) + kFollowGapM);
  if (speed_mps < kHoldMps && leader_mps < kHoldMps && gap_m < wanted_m + kHoldM) return -kRestMps2;
  return comfort.acceleration_mps2 * (1.0F - square(wanted_m / max(gap_m, 0.5F)));
}

/// Closes on a place that moves at `place_mps`: fast as long as comfortable braking (or, from ahead, drive)
/// still settles there.
float for_place(float ahead_m, float speed_mps, float place_mps, const Parameters& parameters) {
  const auto& comfort = parameters.comfort;
  const float change = kBegin * (ahead_m > 0.0F ? comfort.braking_mps2 : comfort.acceleration_mps2);
  const float closing_mps =
      sqrt(2.0F * change * abs(ahead_m) + square(change * kSettleS)) - change * kSettleS;
  const float wanted_mps = place_mps + (ahead_m > 0.0F ? closing_mps : -closing_mps);
  return max(-comfort.braking_mps2, (wanted_mps - speed_mps) / kReactS);
}

}  // namespace

float wanted_acceleration(const ReferenceLine& line, const Candidate& candidate,
                          const LongitudinalState& state, float time_s, const Parameters& parameters) {
  const bool brisk = candidate.acceleration_mps2 > parameters.comfort.acceleration_mps2;
  float wanted = min(candidate.acceleration_mps2, for_cap(line, state, brisk, parameters));
  if (wanted <= 0.0F && state.speed_mps < kHoldMps) wanted = min(wanted, -kRestMps2);  // nobody crawls
  if (candidate.intent == Intent::kStop) {
    const float left_m = candidate.target_s_m - state.s_m;
    wanted = min(wanted, for_stop(left_m, state.speed_mps, parameters.comfort.braking_mps2));
  } else if (candidate.intent == Intent::kFollow) {
    const float ahead_m = candidate.target_s_m + candidate.target_speed_mps * time_s - state.s_m;
    wanted = min(wanted, candidate.in_gap
                             ? for_place(ahead_m, state.speed_mps, candidate.target_speed_mps, parameters)
                             : for_leader(ahead_m, state.speed_mps, candidate.target_speed_mps, parameters));
  }
  return wanted;
}

float advance(float wanted_mps2, const Parameters& parameters, LongitudinalState& state) {
  const auto& vehicle = parameters.vehicle;
  const float before_mps = state.speed_mps;
  const float before_mps2 = state.acceleration_mps2;
  const float bounded = clamp(wanted_mps2, -vehicle.braking_max_mps2, vehicle.acceleration_max_mps2);
  const float up = before_mps2 < 0.0F ? kBrakeJerkMps3 : kDriveJerkMps3;
  const float down = bounded < kHardMps2 ? occupancy::kHardJerkMps3 : kBrakeJerkMps3;
  float now_mps2 = clamp(bounded, before_mps2 - down * kStepS, before_mps2 + up * kStepS);
  if (before_mps <= 0.0F && wanted_mps2 > 0.0F) now_mps2 = min(bounded, max(now_mps2, up * kStepS));

  const float mean_mps2 = 0.5F * (before_mps2 + now_mps2);
  const float now_mps = before_mps + mean_mps2 * kStepS;
  if (now_mps <= 0.0F || (now_mps < 0.5F * kHoldMps && wanted_mps2 < 0.0F)) {
    state.speed_mps = 0.0F;
    state.acceleration_mps2 = 0.0F;
    // Rest is reached within the step: at the mean deceleration, or half the step's way when it is tiny.
    const float way_m = mean_mps2 < -0.01F ? square(before_mps) / (-2.0F * mean_mps2) : 0.0F;
    return min(way_m, 0.5F * before_mps * kStepS);
  }
  state.speed_mps = now_mps;
  state.acceleration_mps2 = now_mps2;
  return 0.5F * (before_mps + now_mps) * kStepS;
}

}  // namespace s4tp::trajectory
