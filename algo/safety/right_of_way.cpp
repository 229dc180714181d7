#include "algo/safety/right_of_way.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {
namespace {

constexpr float kBrakingMps2 = -1.0F;  // gentler is no answer to us
constexpr float kMovingMps = 1.0F;     // slower is standing
constexpr float kNever = 1e3F;         // s
constexpr float kPassedFirstS = 0.4F;  // others who clear a zone this long before we enter it went first
constexpr float kTrustedGain = 0.5F;   // share of a present acceleration counted on in that judgement
constexpr float kBesideS = 0.5F;       // between us and one who should yield but will not
constexpr float kBendRad = 0.5F;       // lanes that turn by less are driven like straight ones
constexpr float kHurriedLateralMps2 = 7.0F;  // nobody turns faster
constexpr float kHurriedBrakingMps2 = 6.0F;  // or brakes for the turn later

/// Whether its present braking, kept up, ends before the zone.
bool is_stopping(const Agent& agent, const Approach& approach) {
  const float braking = agent.track.acceleration_mps2;
  return braking < kBrakingMps2 &&
         square(agent.track.speed_mps) <= -2.0F * braking * max(approach.to_entry_m, 0.0F);
}

/// When the vehicle will have covered `way_m` if it goes on braking as it does, or gaining half as much.
float clear_time_s(const Track& track, float way_m) {
  const float gain =
      track.acceleration_mps2 > 0.0F ? kTrustedGain * track.acceleration_mps2 : track.acceleration_mps2;
  const float square_m2ps2 = square(track.speed_mps) + 2.0F * gain * way_m;
  if (square_m2ps2 <= square(kMovingMps)) return kNever;  // it stops, or nearly, before it has cleared
  return 2.0F * way_m / (track.speed_mps + sqrt(square_m2ps2));
}

/// Speed nobody exceeds in the lane's bend; large when it has none.
float bend_speed_mps(const Lane& lane) {
  if (lane.point_count < 3) return kNever;
  const Point first = lane.points[1] - lane.points[0];
  const Point last = lane.points[lane.point_count - 1] - lane.points[lane.point_count - 2];
  const float turned_rad = abs(atan2(cross(first, last), dot(first, last)));
  return turned_rad < kBendRad ? kNever : sqrt(kHurriedLateralMps2 * lane.length_m / turned_rad);
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

/// How soon the vehicle, free to accelerate, can have driven `way_m`, which ends in the zone's lane.
float earliest_time_s(const Scene& scene, const Agent& agent, const ConflictZone& zone, float way_m,
                      const Parameters& parameters) {
  if (way_m <= 0.0F) return 0.0F;
  const Lane& lane = scene.map->lanes[zone.other_lane];
  float limit_mps = lane.speed_limit_mps;
  if (agent.lane != kNoLaneIndex) limit_mps = max(limit_mps, scene.map->lanes[agent.lane].speed_limit_mps);
  float speed_mps = agent.track.speed_mps;
  const float top_mps = max(max(limit_mps * parameters.safety.over_limit, speed_mps), 0.1F);
  const float gain_mps2 = parameters.rss.acceleration_mps2;

  const float bend_mps = bend_speed_mps(lane);
  if (bend_mps >= top_mps) return min(kNever, cover_s(way_m, gain_mps2, top_mps, speed_mps));
  // Into a turn: free to the turn's start, less what braking for it takes, and through it at most as it can
  // be driven.
  const float in_bend_m = min(way_m, zone.other_entry_m);
  const float to_bend_s = cover_s(way_m - in_bend_m, gain_mps2, top_mps, speed_mps);
  const float faster_mps = max(0.0F, speed_mps - bend_mps);
  const float lost_s =
      way_m > in_bend_m ? square(faster_mps) / (2.0F * kHurriedBrakingMps2 * max(speed_mps, 1.0F)) : 0.0F;
  speed_mps = faster_mps > 0.0F ? bend_mps : speed_mps;
  return min(kNever, to_bend_s + lost_s + cover_s(in_bend_m, gain_mps2, max(bend_mps, speed_mps), speed_mps));
}

}  // namespace

Approach approach_to(const Agent& agent, const ConflictZone& zone) {
  Approach nearest;
  for (int p = 0; p < agent.paths.size(); ++p) {
    for (const PathLane& entry : agent.paths[p].lanes) {
      if (entry.lane != zone.other_lane) continue;
      const float along_m = agent.frenet[p].s_m - entry.start_s_m;  // its place, from that lane's start
      const float to_exit_m = zone.other_exit_m - along_m;
      const float to_entry_m = zone.other_entry_m - along_m;
      if (to_exit_m <= 0.0F) continue;
      if (!nearest.reaches || to_entry_m < nearest.to_entry_m) nearest = {true, to_entry_m, to_exit_m};
    }
  }
  return nearest;
}

bool can_stop_for_us(const Agent& agent, const Approach& approach) {
  return approach.to_entry_m > 0.0F &&
         square(agent.track.speed_mps) <= 2.0F * kTrustedBrakingMps2 * approach.to_entry_m;
}

bool will_yield(const EgoPath& path, const Agent& agent) {
  bool owes = false;
  for (const ConflictZone& zone : path.zones) {
    const Approach approach = approach_to(agent, zone);
    if (!approach.reaches) continue;
    const bool gives_way = zone.priority == Priority::kFirstHasPriority || is_stopping(agent, approach);
    if (!gives_way || !can_stop_for_us(agent, approach)) return false;
    owes = true;
  }
  return owes;
}

float earliest_arrival_s(const Scene& scene, int agent_index, const ConflictZone& zone,
                         const Parameters& parameters) {
  const Agent& agent = scene.agents[agent_index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches || scene.map == nullptr) return kNever;
  return earliest_time_s(scene, agent, zone, approach.to_entry_m, parameters);
}

bool leaves_zone_to_us(const Scene& scene, int index, const ConflictZone& zone, float in_s, float out_s,
                       bool committed, const Parameters& parameters) {
  const Agent& agent = scene.agents[index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches) return true;
  if (clear_time_s(agent.track, approach.to_exit_m) + kPassedFirstS < in_s) return true;
  if (approach.to_entry_m <= 0.0F) return false;

  const float arrival_s = earliest_arrival_s(scene, index, zone, parameters);
  const bool we_yield =
      zone.priority == Priority::kFirstYields || (zone.priority == Priority::kFirstCome && arrival_s < in_s);
  if (we_yield && !committed) {
    // Who comes after us into the same lane may be on the ground shared while we are: not when we leave it.
    const float meeting_s =
        zone.merging ? earliest_time_s(scene, agent, zone, approach.to_exit_m, parameters) : arrival_s;
    return meeting_s > out_s + parameters.safety.zone_margin_s;
  }
  // It owes us the way, or we can no longer stop: will it, at its present speed, be there while we are?
  if (!we_yield && can_stop_for_us(agent, approach)) return true;
  const float speed_mps = agent.track.speed_mps;
  return speed_mps < kMovingMps || approach.to_entry_m / speed_mps > out_s + kBesideS;
}

}  // namespace s4tp
