#include "algo/safety/right_of_way.hpp"

#include "algo/core/inline.hpp"
#include "algo/scene/agent_paths.hpp"

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

constexpr float kPedalS = 0.5F;  // from braking to gaining speed
constexpr float kStandsMps = 0.3F;
constexpr float kOverlapS =
    0.3F;  // of one leaving and one who stands, starting now: less than he needs to start
constexpr int kGivenUpMs =
    2000;  // who stands for longer with nobody to wait for does not use his right of way
constexpr float kStartS = 0.5F;       // until somebody who stands is under way
constexpr float kGentlyMps2 = 2.0F;   // easily braked with
constexpr float kQueueingMps = 5.0F;  // faster behind one who stands may be about to pass him
constexpr float kSlowMps = 5.0F;      // who is no faster is easily stopped
constexpr float kAtLineM = 2.0F;      // this near before a stop line is at it

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

/// Who decides when the vehicle comes to the zone: who stands before it in its own lane, or itself.
int head_of_queue(const Scene& scene, int index, Approach& approach) {
  const Agent& agent = scene.agents[index];
  if (agent.track.speed_mps > kQueueingMps) return index;
  const LanePath& path = agent.paths[approach.path];
  const float own_s_m = agent.frenet[approach.path].s_m;
  const float entry_s_m = own_s_m + approach.to_entry_m;
  int head = index;
  float nearest_s_m = own_s_m;
  for (int i = 0; i < scene.agents.size(); ++i) {
    float s_m = 0.0F;
    if (i == index || scene.agents[i].idle_ms < kGivenUpMs) continue;
    if (!arc_length_on(path, scene.agents[i], s_m)) continue;
    if (s_m <= nearest_s_m || s_m >= entry_s_m) continue;
    head = i;
    nearest_s_m = s_m;
  }
  approach.to_exit_m = approach.to_exit_m - (nearest_s_m - own_s_m);
  approach.to_entry_m = entry_s_m - nearest_s_m;
  return head;
}

/// Whether it has stood for a second.
bool stands(const Agent& agent) {
  for (int i = 0; i < kHistorySamples; ++i) {
    if ((agent.history.valid >> i & 1) == 0 || agent.history.samples[i].speed_mps > kStandsMps) return false;
  }
  return true;
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

  // Who brakes does not gain speed at once.
  float before_s = 0.0F;
  if (agent.track.acceleration_mps2 < kBrakingMps2) {
    const float later_mps = max(0.0F, speed_mps + agent.track.acceleration_mps2 * kPedalS);
    const float braked_m = 0.5F * (speed_mps + later_mps) * kPedalS;
    if (braked_m < way_m) {
      before_s = kPedalS;
      way_m = way_m - braked_m;
      speed_mps = later_mps;
    }
  }
  const float bend_mps = bend_speed_mps(lane);
  if (bend_mps >= top_mps) return min(kNever, before_s + cover_s(way_m, gain_mps2, top_mps, speed_mps));
  // Into a turn: free to the turn's start, less what braking for it takes, and through it at most as it can
  // be driven.
  const float in_bend_m = min(way_m, zone.other_entry_m);
  const float to_bend_s = cover_s(way_m - in_bend_m, gain_mps2, top_mps, speed_mps);
  const float faster_mps = max(0.0F, speed_mps - bend_mps);
  const float lost_s =
      way_m > in_bend_m ? square(faster_mps) / (2.0F * kHurriedBrakingMps2 * max(speed_mps, 1.0F)) : 0.0F;
  speed_mps = faster_mps > 0.0F ? bend_mps : speed_mps;
  return min(kNever, before_s + to_bend_s + lost_s +
                         cover_s(in_bend_m, gain_mps2, max(bend_mps, speed_mps), speed_mps));
}

}  // namespace

float zone_margin_s(const Scene& scene, Resolve resolve, const Parameters& parameters) {
  if (resolve != Resolve::kConsidering) return 0.0F;
  const auto& safety = parameters.safety;
  return scene.waited_s > safety.patience_s ? min(safety.zone_margin_waited_s, safety.zone_margin_s)
                                            : safety.zone_margin_s;
}

Approach approach_to(const Agent& agent, const ConflictZone& zone) {
  Approach nearest;
  for (int p = 0; p < agent.paths.size(); ++p) {
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

bool can_stop_for_us(const Agent& agent, const Approach& approach) {
  return approach.to_entry_m > 0.0F &&
         square(agent.track.speed_mps) <= 2.0F * kTrustedBrakingMps2 * approach.to_entry_m;
}

bool waits_beyond_line(const Scene& scene, float line_s_m, float start_s_m) {
  return scene.waited_s > 0.0F && start_s_m > line_s_m - kAtLineM;
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

bool lets_us_finish(const Scene& scene, const EgoPath& path, float own_s_m, float own_mps, const Agent& agent,
                    const Parameters& parameters) {
  if (agent.track.speed_mps > kSlowMps) return false;
  bool under_way = false;
  bool meets = false;
  for (const ConflictZone& zone : path.zones) {
    const float to_entry_m = max(zone.entry_s_m - own_s_m, 0.0F);
    const bool stops = square(own_mps) <= 2.0F * parameters.comfort.braking_mps2 * to_entry_m;
    under_way = under_way || (!stops && own_s_m < zone.exit_s_m);
    const Approach approach = approach_to(agent, zone);
    if (!approach.reaches || own_s_m > zone.exit_s_m) continue;
    meets = true;
    if (approach.to_entry_m <= 0.0F) return false;
    if (square(agent.track.speed_mps) > 2.0F * kGentlyMps2 * approach.to_entry_m) return false;
    const float ours_s = to_entry_m / max(own_mps, kMovingMps);
    if (ours_s > earliest_time_s(scene, agent, zone, approach.to_entry_m, parameters)) return false;
  }
  return under_way && meets;
}

float earliest_arrival_s(const Scene& scene, int agent_index, const ConflictZone& zone,
                         const Parameters& parameters) {
  const Agent& agent = scene.agents[agent_index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches || scene.map == nullptr) return kNever;
  return earliest_time_s(scene, agent, zone, approach.to_entry_m, parameters);
}

bool leaves_zone_to_us(const Scene& scene, int index, const ConflictZone& zone, float in_s, float out_s,
                       Resolve resolve, const Parameters& parameters) {
  const Agent& agent = scene.agents[index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches) return true;
  if (clear_time_s(agent.track, approach.to_exit_m) + kPassedFirstS < in_s) return true;
  if (approach.to_entry_m <= 0.0F) return false;

  const float arrival_s = earliest_arrival_s(scene, index, zone, parameters);
  const bool we_yield =
      zone.priority == Priority::kFirstYields || (zone.priority == Priority::kFirstCome && arrival_s < in_s);
  if (we_yield && resolve != Resolve::kCommitted) {
    Approach first = approach;
    const Agent& head = scene.agents[head_of_queue(scene, index, first)];
    const float start_s = earliest_time_s(scene, head, zone, first.to_entry_m, parameters);
    if (head.idle_ms >= kGivenUpMs && in_s < start_s + kStartS) return true;
    if (stands(head) && out_s < start_s + kOverlapS) return true;
    const bool slow = agent.track.speed_mps < kSlowMps &&
                      square(agent.track.speed_mps) <= 2.0F * kGentlyMps2 * approach.to_entry_m;
    if (resolve == Resolve::kUnderWay && slow && in_s < arrival_s) return true;
    // Who comes after us into the same lane may be on the ground shared while we are: not when we leave it.
    const float meeting_s =
        zone.merging ? earliest_time_s(scene, agent, zone, approach.to_exit_m, parameters) : arrival_s;
    return meeting_s > out_s + zone_margin_s(scene, resolve, parameters);
  }
  // It owes us the way, or we can no longer stop: will it, at its present speed, be there while we are?
  if (!we_yield && can_stop_for_us(agent, approach)) return true;
  const float speed_mps = agent.track.speed_mps;
  return speed_mps < kMovingMps || approach.to_entry_m / speed_mps > out_s + kBesideS;
}

}  // namespace s4tp
