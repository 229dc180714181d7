#include "algo/safety/right_of_way.hpp"

#include "algo/core/inline.hpp"
#include "algo/scene/agent_paths.hpp"

namespace s4tp {
namespace {

constexpr float kMovingMps = 1.0F;     // slower is standing
constexpr float kStandsMps = 0.3F;     // all that a standing car's measured speed may be
constexpr float kPassedFirstS = 0.1F;  // others who clear a zone this long before we enter it went first
constexpr float kBesideS = 0.5F;       // between us and one who should yield but will not
constexpr float kFirstInS = 0.3F;      // before another we are plainly first
constexpr float kWellFirstS = 1.0F;    // before one who is setting off, and may not see that we do, too
constexpr float kSettingOffMps2 = 1.0F;
constexpr float kOverlapS = 0.3F;  // of one leaving and one who stands, starting now: less than he needs
constexpr float kHesitation =
    0.25F;                           // who has left it unused for long goes on so for this share of that time
constexpr float kStartS = 0.5F;      // until somebody who stands is under way
constexpr float kGentlyMps2 = 2.0F;  // easily braked with
constexpr float kSlowMps = 5.0F;     // who is no faster is easily stopped; a faster one may pass who stands
constexpr float kFollowingS = 1.0F;  // from one who sets off to the next
constexpr float kFirmly = 1.4F;      // times comfort: a stop at the line, a little late, is no crossing begun
constexpr float kForEverS = 20.0F;   // who has waited so long will not be let in where he stands
constexpr float kAtLineM = 2.0F;     // this near before a stop line is at it
constexpr float kWaitingPlaceM = 2.5F;  // between two zones there is room to wait, clear of both

/// Whether its present braking, kept up, ends before the zone.
bool is_stopping(const Agent& agent, const Approach& approach) {
  const float braking = agent.track.acceleration_mps2;
  return braking < kPlainBrakingMps2 &&
         square(agent.track.speed_mps) <= -2.0F * braking * max(approach.to_entry_m, 0.0F);
}

bool can_stop(const Agent& agent, float way_m, float braking_mps2) {
  return way_m > 0.0F && square(agent.track.speed_mps) <= 2.0F * braking_mps2 * way_m;
}

/// Whether it has stood for a second.
bool stands(const Agent& agent) {
  for (int i = 0; i < kHistorySamples; ++i) {
    if ((agent.history.valid >> i & 1) == 0 || agent.history.samples[i].speed_mps > kStandsMps) return false;
  }
  return true;
}

/// The head of the queue the vehicle is in or comes to: who stands nearest to the zone on its way there, or
/// itself.
struct Head {
  int agent;
  float to_entry_m;  ///< of the head
};
Head head_of_queue(const Scene& scene, int index, const Approach& approach) {
  const Agent& agent = scene.agents[index];
  const LanePath& path = agent.paths[approach.path];
  const float entry_s_m = agent.frenet[approach.path].s_m + approach.to_entry_m;
  Head head{index, max(approach.to_entry_m, 0.0F)};
  for (int i = 0; i < scene.agents.size(); ++i) {
    const Agent& other = scene.agents[i];
    if (i == index || !(other.idle_ms >= kGivenUpMs || stands(other))) continue;
    float s_m = 0.0F;
    if (!arc_length_on(path, other, s_m)) continue;
    const float to_entry_m = entry_s_m - s_m;
    if (to_entry_m > 0.0F && to_entry_m < head.to_entry_m) head = {i, to_entry_m};
  }
  return head;
}

/// Whether it, though it has the right of way and could come while we are there, will let us.
bool is_trusted(const Scene& scene, int index, const ConflictZone& zone, const Approach& approach, float in_s,
                float out_s, Resolve resolve, const Parameters& parameters) {
  const Agent& agent = scene.agents[index];
  const Head first = head_of_queue(scene, index, approach);
  const Agent& head = scene.agents[first.agent];
  const float start_s = earliest_time_s(scene, head, zone, first.to_entry_m, parameters);
  const bool waited = scene.waited_s > parameters.safety.patience_s;
  if (first.agent == index || agent.track.speed_mps < kSlowMps) {
    const float unused_s = max(kStartS, kHesitation * 0.001F * static_cast<float>(head.idle_ms));
    if (head.idle_ms >= kGivenUpMs && in_s < start_s + unused_s) return true;
    if (stands(head) && (out_s < start_s + kOverlapS || (waited && in_s + kFirstInS < start_s))) return true;
  }

  const bool under_way = resolve != Resolve::kConsidering;
  if (!waited && !under_way) return false;
  // Who finds us on the ground shared brakes as hard as it takes.
  const float braking_mps2 = in_s > 0.0F ? kGentlyMps2 : kTrustedBrakingMps2;
  if (!can_stop(agent, approach.to_entry_m, braking_mps2)) return false;
  if (under_way && agent.track.speed_mps < kSlowMps) {
    const bool sets_off = agent.track.acceleration_mps2 > kSettingOffMps2 && in_s > 0.0F;
    const float first_s = in_s + (sets_off ? kWellFirstS : kFirstInS);
    if (first_s < earliest_time_s(scene, agent, zone, approach.to_entry_m, parameters)) return true;
  }
  const Approach expected = approach_to(agent, zone, kLikelyWay);
  if (!expected.reaches) return true;
  const float needed_s = out_s + zone_margin_s(scene, resolve, parameters);
  if (first.agent != index)  // not before the one in front of it
    return expected_time_s(scene, head, zone, first.to_entry_m) + kFollowingS > needed_s;
  return expected_time_s(scene, agent, zone, zone.merging ? expected.to_exit_m : expected.to_entry_m) >
         needed_s;
}

}  // namespace

bool can_stop_for_us(const Agent& agent, const Approach& approach) {
  return can_stop(agent, approach.to_entry_m, kTrustedBrakingMps2);
}

float under_way_until_s_m(const EgoPath& path, float own_s_m, float own_mps, const Parameters& parameters) {
  float until_s_m = own_s_m;
  bool under_way = false;
  for (const ConflictZone& zone : path.zones) {  // in the order of their entries
    if (zone.exit_s_m <= own_s_m) continue;
    if (!under_way) {
      const float to_entry_m = zone.entry_s_m - own_s_m;
      const float braking_mps2 = kFirmly * parameters.comfort.braking_mps2;
      under_way = to_entry_m <= 0.0F || square(own_mps) > 2.0F * braking_mps2 * to_entry_m;
      if (!under_way) break;
    } else if (zone.entry_s_m - until_s_m > kWaitingPlaceM) {
      break;
    }
    until_s_m = max(until_s_m, zone.exit_s_m);
  }
  return until_s_m;
}

float zone_margin_s(const Scene& scene, Resolve resolve, const Parameters& parameters) {
  if (resolve != Resolve::kConsidering) return 0.0F;
  const auto& safety = parameters.safety;
  return scene.waited_s > safety.patience_s ? min(safety.zone_margin_waited_s, safety.zone_margin_s)
                                            : safety.zone_margin_s;
}

bool waits_beyond_line(const Scene& scene, float line_s_m, float start_s_m) {
  return scene.waited_s > kForEverS && start_s_m > line_s_m - kAtLineM;
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

Passage judge_passage(const Scene& scene, int index, const ConflictZone& zone, float in_s, float out_s,
                      Resolve resolve, const Parameters& parameters) {
  const Agent& agent = scene.agents[index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches) return Passage::kFree;
  if (clear_time_s(agent.track, approach.to_exit_m) + kPassedFirstS < in_s) return Passage::kFree;
  if (approach.to_entry_m <= 0.0F && agent.idle_ms < kGivenUpMs) return Passage::kRefused;

  const float arrival_s = earliest_arrival_s(scene, index, zone, parameters);
  const bool we_yield =
      zone.priority == Priority::kFirstYields || (zone.priority == Priority::kFirstCome && arrival_s < in_s);
  if (!we_yield && can_stop_for_us(agent, approach)) return Passage::kFree;
  const float speed_mps = agent.track.speed_mps;
  const bool later = speed_mps < kMovingMps || approach.to_entry_m / speed_mps > out_s + kBesideS;
  if (!we_yield) return later ? Passage::kFree : Passage::kRefused;  // it should yield, but will not

  // Who comes after us into the same lane may be on the ground shared while we are: not when we leave it.
  const float meeting_s =
      zone.merging ? earliest_time_s(scene, agent, zone, approach.to_exit_m, parameters) : arrival_s;
  const bool clearly_later = meeting_s > out_s + zone_margin_s(scene, resolve, parameters);
  if (resolve == Resolve::kConsidering && clearly_later) return Passage::kFree;
  if (clearly_later || (resolve == Resolve::kCommitted && later)) return Passage::kTrusted;
  const bool trusted = is_trusted(scene, index, zone, approach, in_s, out_s, resolve, parameters);
  return trusted ? Passage::kTrusted : Passage::kRefused;
}

}  // namespace s4tp
