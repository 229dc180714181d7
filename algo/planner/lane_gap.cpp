#include "algo/planner/lane_gap.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/sort.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/safety/change_gaps.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::planner {
namespace {

using occupancy::kNeverS;
using occupancy::stopping_way_m;

constexpr float kPatienceS = 8.0F;
constexpr float kDuePatienceS = 20.0F;
constexpr float kInsetM = 0.2F;     // from both ends of a gap: vehicles do not keep their speeds exactly
constexpr float kShare = 0.8F;      // of comfortable drive and braking
constexpr float kHardlyMps = 0.1F;  // faster than that a vehicle is not gained on
constexpr float kAlikeMps = 0.5F;   // speeds in a column differ by this from one moment to the next

/// Time to gain `way_m` >= 0 and end with no speed, from `speed` (relative ones), with `up` while gaining
/// speed, `down` while losing it, and `top` at most. \pre without more drive we end before that
float time_to_gain_s(float way_m, float speed, float up, float down, float top) {
  const float effort = 2.0F * way_m + square(speed) / up;
  const float peak = sqrt(effort * up * down / (up + down));
  if (peak <= top) return (peak - speed) / up + peak / down;
  if (top < kHardlyMps) return kNeverS;
  const float steady_m = way_m - (square(top) - square(speed)) / (2.0F * up) - square(top) / (2.0F * down);
  return max(0.0F, top - speed) / up + top / down + steady_m / top;
}

/// A vehicle hardly faster than the one ahead is in a column with it, and comes no nearer.
void keep_distance(const LaneVehicle& ahead, LaneVehicle& vehicle) {
  const float faster_mps = vehicle.speed_mps - ahead.speed_mps;
  if (faster_mps <= 0.0F || faster_mps > kAlikeMps) return;
  vehicle.s_m = vehicle.s_m - faster_mps * kHorizonS;
  vehicle.speed_mps = ahead.speed_mps;
}

}  // namespace

LaneGap gap_between(const LaneVehicle* front, const LaneVehicle* rear, float limit_mps,
                    const Parameters& parameters) {
  LaneGap gap;
  gap.speed_mps = limit_mps;
  if (front != nullptr) gap.speed_mps = min(gap.speed_mps, front->speed_mps);
  if (rear != nullptr) gap.speed_mps = min(gap.speed_mps, rear->speed_mps);
  gap.bounded_ahead = front != nullptr;
  gap.bounded_behind = rear != nullptr;
  if (front != nullptr) {
    const float distance_m =
        max(kInsetM, safety::change_gap_to_leader_m(gap.speed_mps, front->speed_mps, parameters) + kInsetM);
    gap.front_s_m =
        front->s_m - 0.5F * front->length_m - distance_m - trajectory::rear_axle_to_front_m(parameters);
  }
  if (rear != nullptr) {
    const float distance_m =
        safety::change_gap_to_follower_m(gap.speed_mps, rear->speed_mps, parameters) + kInsetM;
    gap.rear_s_m = rear->s_m + 0.5F * rear->length_m + distance_m + parameters.vehicle.rear_overhang_m;
  }
  gap.found = front == nullptr || rear == nullptr || gap.front_s_m >= gap.rear_s_m;
  return gap;
}

void put_in_order(LaneVehicles& vehicles) {
  sort(vehicles, [](const LaneVehicle& a, const LaneVehicle& b) { return a.s_m > b.s_m; });
  const LaneVehicle* front[2] = {nullptr, nullptr};
  for (LaneVehicle& vehicle : vehicles) {
    const LaneVehicle*& ahead = front[vehicle.in_lane ? 1 : 0];
    if (ahead != nullptr) keep_distance(*ahead, vehicle);
    ahead = &vehicle;
  }
}

float time_to_meet_s(const LaneGap& gap, float ahead_s, float s_m, float speed_mps, float limit_mps,
                     const Parameters& parameters) {
  const float drive = kShare * parameters.comfort.acceleration_mps2;
  const float braking = kShare * parameters.comfort.braking_mps2;
  // In a frame that moves with the gap.
  const float now_m = s_m + gap.speed_mps * ahead_s;
  const float speed = speed_mps - gap.speed_mps;
  const float matched_m =
      now_m + (speed > 0.0F ? stopping_way_m(speed, braking) : -stopping_way_m(speed, drive));
  if (gap.bounded_behind && matched_m < gap.rear_s_m) {
    return time_to_gain_s(gap.rear_s_m - now_m, speed, drive, braking, limit_mps - gap.speed_mps);
  }
  if (gap.bounded_ahead && matched_m > gap.front_s_m) {
    return time_to_gain_s(now_m - gap.front_s_m, -speed, braking, drive, gap.speed_mps);
  }
  if (speed > 0.0F) return gap.bounded_ahead ? speed / braking : 0.0F;
  return gap.bounded_behind ? -speed / drive : 0.0F;
}

float place_in_gap_m(const LaneGap& gap, float ahead_s, float s_m, float speed_mps, float time_s) {
  const float moved_m = gap.speed_mps * (time_s - ahead_s);
  float place_m = s_m + 0.5F * (speed_mps + gap.speed_mps) * time_s;
  if (gap.bounded_behind) place_m = max(place_m, gap.rear_s_m + moved_m);
  if (gap.bounded_ahead) place_m = min(place_m, gap.front_s_m + moved_m);
  return place_m;
}

LaneGap find_lane_gap(const LaneVehicles& vehicles, const GapSeeker& us, const Parameters& parameters) {
  LaneVehicles lane;
  for (const LaneVehicle& vehicle : vehicles) {
    if (vehicle.in_lane) (void)lane.push(vehicle);
  }
  if (lane.empty()) return {};
  for (int i = 0; i <= lane.size(); ++i) {
    const LaneVehicle* front = i > 0 ? &lane[i - 1] : nullptr;
    const LaneVehicle* rear = i < lane.size() ? &lane[i] : nullptr;
    const LaneGap gap = gap_between(front, rear, us.limit_mps, parameters);
    if (!gap.found) continue;
    const float time_s = time_to_meet_s(gap, kHorizonS, us.s_m, us.speed_mps, us.limit_mps, parameters);
    if (time_s > (us.change_due ? kDuePatienceS : kPatienceS)) continue;
    const float place_m = place_in_gap_m(gap, kHorizonS, us.s_m, us.speed_mps, time_s);
    const float stop_m = stopping_way_m(gap.speed_mps, parameters.comfort.braking_mps2);
    if (us.change_due && place_m + max(stop_m, scene::kChangeWayM) > us.end_s_m) continue;
    const float leader_s_m = us.leader_s_m + us.leader_mps * time_s - parameters.comfort.standstill_gap_m;
    if (us.has_leader && place_m > leader_s_m) continue;
    return gap;
  }
  return {};
}

}  // namespace s4tp::planner
