#include "algo/safety/legal_occupancy.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"

namespace s4tp::safety {
namespace {

using occupancy::kNeverS;
using occupancy::Pace;

constexpr float kSetsOffMps2 = 0.5F;
constexpr float kStandOffS = 2.0F;     // when all have stood so long any one may go
constexpr float kShortOfZoneM = 0.5F;  // who gives way stops so far before
constexpr float kBendRad = 0.5F;       // lanes that turn by less are driven like straight ones

/// Speed that grip allows in the lane's bend; large when it has none.
float grip_speed_mps(const Lane& lane) {
  if (lane.point_count < 3) return kNeverS;
  const Point first = lane.points[1] - lane.points[0];
  const Point last = lane.points[lane.point_count - 1] - lane.points[lane.point_count - 2];
  const float turned_rad = abs(atan2(cross(first, last), dot(first, last)));
  return turned_rad < kBendRad ? kNeverS : sqrt(occupancy::kGripMps2 * lane.length_m / turned_rad);
}

float seconds(std::uint16_t time_ms) {
  return 1e-3F * static_cast<float>(time_ms);
}

/// D1 and D2: whoever owes us the way, or finds us there by right, stops before the zone if the duty's braking
/// does it after the response.
bool can_stop(const scene::Agent& agent, float to_entry_m, float response_s, const Parameters& parameters) {
  const auto& law = parameters.law;
  const float room_m = to_entry_m - seen_mps(agent) * response_s;
  return room_m > 0.0F && occupancy::stopping_way_m(seen_mps(agent), law.duty_braking_mps2) <= room_m;
}

/// L1. Who gains speed does not leave it to us.
bool can_stop_gently(const scene::Agent& agent, const Pace& fastest, float to_entry_m, float unseen_s,
                     const Parameters& parameters) {
  const auto& law = parameters.law;
  if (agent.track.acceleration_mps2 >= kSetsOffMps2) return false;
  const float asked_s = unseen_s + law.ask_response_s;
  const float room_m = to_entry_m - kShortOfZoneM - occupancy::way_after_m(fastest, asked_s);
  const float later_mps = occupancy::speed_after_mps(fastest, asked_s);
  return room_m > 0.0F && square(later_mps) <= 2.0F * law.ask_braking_mps2 * room_m;
}

/// L2: it and we, for `since_s`. Who is not seen any more may have set off.
bool stands_in_sight(const scene::Scene& scene, const scene::Agent& agent, float since_s) {
  return agent.age_ms <= scene::kFreshMs && agent.track.speed_mps < kStandingMps &&
         agent.track.acceleration_mps2 < kSetsOffMps2 && seconds(agent.stood_ms) >= since_s &&
         scene.waited_s >= since_s;
}

}  // namespace

float seen_mps(const scene::Agent& agent) {
  return max(agent.track.speed_mps - agent.coasted_mps, 0.0F);
}

Pace fastest_legal(const scene::Scene& scene, LaneIndex lane, float speed_mps,
                   const scene::ConflictZone& zone, const Parameters& parameters) {
  float limit_mps = scene.map->lanes[zone.other_lane].speed_limit_mps;
  if (lane != kNoLaneIndex) limit_mps = max(limit_mps, scene.map->lanes[lane].speed_limit_mps);
  return {speed_mps, parameters.law.gain_mps2, max(parameters.law.over_limit * limit_mps, speed_mps)};
}

Pace fastest_legal(const scene::Scene& scene, const scene::Agent& agent, const scene::ConflictZone& zone,
                   const Parameters& parameters) {
  // Who gains speed faster than the law lets it has broken it, and may go on doing so.
  Pace fastest = fastest_legal(scene, agent.lane, seen_mps(agent), zone, parameters);
  fastest.gain_mps2 = max(fastest.gain_mps2, agent.track.acceleration_mps2);
  return fastest;
}

ZoneOccupancy zone_occupancy(const scene::Scene& scene, const scene::Agent& agent,
                             const occupancy::LaneReach& reach, const scene::ConflictZone& zone, float lead_s,
                             const Parameters& parameters) {
  ZoneOccupancy result;
  const float to_lane_m = reach.to_start_m(zone.other_lane);
  if (to_lane_m >= occupancy::kNoWayM) return result;
  const float longer_m = 0.5F * agent.track.length_m - scene::kUsualHalfLengthM;
  result.to_entry_m = to_lane_m + zone.other_entry_m - longer_m;
  result.to_exit_m = to_lane_m + zone.other_exit_m + longer_m;
  if (result.to_exit_m + agent.coasted_m <= 0.0F) return result;

  // Counted from the last sight, whatever we took the vehicle to do since.
  const float unseen_s = seconds(agent.age_ms);
  const float entry_m = result.to_entry_m + agent.coasted_m;
  const float exit_m = result.to_exit_m + agent.coasted_m;
  const Pace fastest = fastest_legal(scene, agent, zone, parameters);
  result.claim = Claim::kMayCome;
  result.until_s =
      occupancy::latest_time_s(seen_mps(agent), parameters.law.braking_max_mps2, exit_m) - unseen_s - lead_s;
  if (result.to_entry_m <= 0.0F) {
    // Where it stands it is an obstacle like any other, and may go on, until all have stood so long that any one may. Where lanes
    // merge its way on is ours.
    if (!zone.merging && !zone.beside && stands_in_sight(scene, agent, kStandOffS))
      result.claim = Claim::kStands;
    result.from_s = -lead_s;
    return result;
  }
  result.from_s = occupancy::time_to_cover_s(fastest, entry_m) - unseen_s - lead_s;
  if (zone.beside) {
    if (stands_in_sight(scene, agent, kStandOffS)) result.claim = Claim::kStands;
    return result;
  }
  // A bend is driven no faster than grip lets it; braking for it is not counted on.
  const float grip_mps = grip_speed_mps(scene.map->lanes[zone.other_lane]);
  if (grip_mps < fastest.top_mps) {
    const float in_bend_m = min(entry_m, max(zone.other_entry_m, 0.0F));
    const float before_s = occupancy::time_to_cover_s(fastest, entry_m - in_bend_m);
    result.from_s = max(result.from_s, before_s + in_bend_m / max(grip_mps, 1.0F) - unseen_s - lead_s);
  }
  const float response_s = parameters.law.duty_response_s;
  result.can_stop = can_stop(agent, entry_m, response_s, parameters);
  if (zone.priority == Priority::kFirstHasPriority) {
    // What it owes it has owed since it was first in sight: the response runs once.
    const float known_s = max(0.0F, seconds(agent.known_ms) - unseen_s);
    if (can_stop(agent, entry_m, max(0.0F, response_s - known_s), parameters)) result.claim = Claim::kOwes;
  } else if (can_stop_gently(agent, fastest, entry_m, unseen_s, parameters)) {
    result.claim = Claim::kCanStop;
  } else if (stands_in_sight(scene, agent, parameters.law.seen_s)) {
    result.claim = Claim::kStands;
  }
  return result;
}

}  // namespace s4tp::safety
