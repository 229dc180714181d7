#include "algo/safety/arrival.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {
namespace {

constexpr float kMovingMps = 1.0F;           // slower is standing
constexpr float kTrustedGain = 0.5F;         // share of a present acceleration counted on to clear ground
constexpr float kBendRad = 0.5F;             // lanes that turn by less are driven like straight ones
constexpr float kHurriedLateralMps2 = 7.0F;  // nobody turns faster
constexpr float kHurriedBrakingMps2 = 6.0F;  // or brakes for the turn later
constexpr float kPedalS = 0.5F;              // from braking to gaining speed
constexpr float kGainingMps2 = 0.2F;         // less is keeping one's speed
constexpr float kStartingMps2 = 1.5F;        // ordinary pace of setting off

/// Speed nobody exceeds in the lane's bend; large when it has none.
float bend_speed_mps(const Lane& lane) {
  if (lane.point_count < 3) return kNeverS;
  const Point first = lane.points[1] - lane.points[0];
  const Point last = lane.points[lane.point_count - 1] - lane.points[lane.point_count - 2];
  const float turned_rad = abs(atan2(cross(first, last), dot(first, last)));
  return turned_rad < kBendRad ? kNeverS : sqrt(kHurriedLateralMps2 * lane.length_m / turned_rad);
}

/// Time to cover `way_m` from `speed_mps`, gaining up to `top_mps`; `speed_mps` becomes the speed reached.
float cover_s(float way_m, float gain_mps2, float top_mps, float& speed_mps) {
  const float start_mps = speed_mps;
  const float gaining_s = (top_mps - start_mps) / gain_mps2;
  const float gaining_m = 0.5F * (top_mps + start_mps) * gaining_s;
  if (way_m >= gaining_m) {
    speed_mps = top_mps;
    return gaining_s + (way_m - gaining_m) / top_mps;
  }
  speed_mps = sqrt(square(start_mps) + 2.0F * gain_mps2 * way_m);
  return (speed_mps - start_mps) / gain_mps2;
}

/// Limit of its lane or of the zone's, the higher of them.
float limit_mps(const Scene& scene, const Agent& agent, const ConflictZone& zone) {
  const float there_mps = scene.map->lanes[zone.other_lane].speed_limit_mps;
  return agent.lane == kNoLaneIndex ? there_mps
                                    : max(there_mps, scene.map->lanes[agent.lane].speed_limit_mps);
}

}  // namespace

Approach approach_to(const Agent& agent, const ConflictZone& zone, float least_probability) {
  Approach nearest;
  for (int p = 0; p < agent.paths.size(); ++p) {
    if (agent.path_probability[p] < least_probability) continue;
    for (const PathLane& entry : agent.paths[p].lanes) {
      if (entry.lane != zone.other_lane) continue;
      const float along_m = agent.frenet[p].s_m - entry.start_s_m;  // its place, from that lane's start
      const float to_exit_m = zone.other_exit_m - along_m;
      const float to_entry_m = zone.other_entry_m - along_m;
      if (to_exit_m <= 0.0F) continue;
      if (!nearest.reaches || to_entry_m < nearest.to_entry_m) nearest = {true, to_entry_m, to_exit_m, p};
    }
  }
  return nearest;
}

float earliest_time_s(const Scene& scene, const Agent& agent, const ConflictZone& zone, float way_m,
                      const Parameters& parameters) {
  if (way_m <= 0.0F) return 0.0F;
  const Lane& lane = scene.map->lanes[zone.other_lane];
  float speed_mps = agent.track.speed_mps;
  const float top_mps =
      max(max(limit_mps(scene, agent, zone) * parameters.safety.over_limit, speed_mps), 0.1F);
  const float gain_mps2 = parameters.rss.acceleration_mps2;

  // Who brakes does not gain speed at once.
  float before_s = 0.0F;
  if (agent.track.acceleration_mps2 < kPlainBrakingMps2) {
    const float later_mps = max(0.0F, speed_mps + agent.track.acceleration_mps2 * kPedalS);
    const float braked_m = 0.5F * (speed_mps + later_mps) * kPedalS;
    if (braked_m < way_m) {
      before_s = kPedalS;
      way_m = way_m - braked_m;
      speed_mps = later_mps;
    }
  }
  const float bend_mps = bend_speed_mps(lane);
  if (bend_mps >= top_mps) return min(kNeverS, before_s + cover_s(way_m, gain_mps2, top_mps, speed_mps));
  // Into a turn: free to the turn's start, less what braking for it takes, and through it at most as it can
  // be driven.
  const float in_bend_m = min(way_m, zone.other_entry_m);
  const float to_bend_s = cover_s(way_m - in_bend_m, gain_mps2, top_mps, speed_mps);
  const float faster_mps = max(0.0F, speed_mps - bend_mps);
  const float lost_s =
      way_m > in_bend_m ? square(faster_mps) / (2.0F * kHurriedBrakingMps2 * max(speed_mps, 1.0F)) : 0.0F;
  speed_mps = faster_mps > 0.0F ? bend_mps : speed_mps;
  return min(kNeverS, before_s + to_bend_s + lost_s +
                          cover_s(in_bend_m, gain_mps2, max(bend_mps, speed_mps), speed_mps));
}

float earliest_arrival_s(const Scene& scene, int agent_index, const ConflictZone& zone,
                         const Parameters& parameters) {
  const Agent& agent = scene.agents[agent_index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches || scene.map == nullptr) return kNeverS;
  return earliest_time_s(scene, agent, zone, approach.to_entry_m, parameters);
}

float expected_time_s(const Scene& scene, const Agent& agent, const ConflictZone& zone, float way_m) {
  if (way_m <= 0.0F) return 0.0F;
  float speed_mps = agent.track.speed_mps;
  const float gain_mps2 = agent.track.acceleration_mps2;
  const bool sets_off = speed_mps < kMovingMps || gain_mps2 < kPlainBrakingMps2;
  const float top_mps = max(limit_mps(scene, agent, zone), max(speed_mps, kMovingMps));
  if (sets_off) return min(kNeverS, kPedalS + cover_s(way_m, kStartingMps2, top_mps, speed_mps));
  if (gain_mps2 < kGainingMps2) return min(kNeverS, way_m / speed_mps);
  return min(kNeverS, cover_s(way_m, gain_mps2, top_mps, speed_mps));
}

float clear_time_s(const Track& track, float way_m) {
  const float gain =
      track.acceleration_mps2 > 0.0F ? kTrustedGain * track.acceleration_mps2 : track.acceleration_mps2;
  const float square_m2ps2 = square(track.speed_mps) + 2.0F * gain * way_m;
  if (square_m2ps2 <= square(kMovingMps)) return kNeverS;  // it stops, or nearly, before it has cleared
  return 2.0F * way_m / (track.speed_mps + sqrt(square_m2ps2));
}

}  // namespace s4tp
