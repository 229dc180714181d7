#include "algo/scene/relevance.hpp"

#include "algo/core/inline.hpp"
#include "algo/scene/agent_paths.hpp"

namespace s4tp::scene {
namespace {

constexpr float kSlowestMps = 2.0F;    // who stands may start: times are taken at no less than this speed
constexpr float kElsewhereS = 100.0F;  // who shares neither zone nor lane comes after all who do
constexpr float kElsewhereSpm = 0.1F;  // ... the nearer first
constexpr float kOtherWayS = 1.0F;     // handicap of what concerns only a lane we are not on yet

// Work (WorkMeter's units).
constexpr int kRankWork = 6;       // of a vehicle, ...
constexpr int kMoveWork = 8;       // ... when its place in the list changes, ...
constexpr int kMeetWork = 4;       // ... with one of our paths, ...
constexpr int kPairsPerUnit = 25;  // ... lanes of its paths beside lanes and zones of ours

// Where our path begins on the agent's, when our first lane lies ahead of it.
bool leads_to_us(const EgoPath& ego_path, const LanePath& path, float& start_s_m) {
  const LaneIndex first = ego_path.path.lanes[0].lane;
  for (const PathLane& part : path.lanes) {
    if (part.lane != first) continue;
    start_s_m = part.start_s_m;
    return true;
  }
  return false;
}

// Time headway in the lane: theirs when they are behind us, ours when they are ahead.
float headway_s(float gap_m, float ego_mps, float agent_mps) {
  const float follower_mps = gap_m > 0.0F ? ego_mps : agent_mps;
  return abs(gap_m) / max(follower_mps, kSlowestMps);
}

// Time until both of us can be at the zone; large when the agent has left it.
float zone_time_s(const ConflictZone& zone, const EgoPath& ego_path, const Agent& agent, int path,
                  float ego_mps) {
  for (const PathLane& part : agent.paths[path].lanes) {
    if (part.lane != zone.other_lane) continue;
    const float half_length_m = 0.5F * agent.track.length_m;
    const float s_m = agent.frenet[path].s_m;
    if (s_m - half_length_m > part.start_s_m + zone.other_exit_m) break;
    const float theirs_m = max(part.start_s_m + zone.other_entry_m - s_m, 0.0F);
    const float ours_m = max(zone.entry_s_m - ego_path.frenet.s_m, 0.0F);
    return max(theirs_m / max(agent.track.speed_mps, kSlowestMps), ours_m / max(ego_mps, kSlowestMps));
  }
  return 2.0F * kElsewhereS;
}

float interaction_time_s(const Scene& scene, const Agent& agent) {
  const float ego_mps = scene.ego.speed_mps;
  const float apart_m = distance(position(scene.ego.rear_axle), position(agent.track.centre));
  float time_s = kElsewhereS + kElsewhereSpm * apart_m;
  for (const EgoPath& ego_path : scene.ego_paths) {
    const float handicap_s = ego_path.manoeuvre == Manoeuvre::kKeep ? 0.0F : kOtherWayS;
    float s_m = 0.0F;
    if (arc_length_on(ego_path.path, agent, s_m)) {
      const float headway = headway_s(s_m - ego_path.frenet.s_m, ego_mps, agent.track.speed_mps);
      time_s = min(time_s, headway + handicap_s);
    }
    for (int i = 0; i < agent.paths.size(); ++i) {
      float start_s_m = 0.0F;
      if (leads_to_us(ego_path, agent.paths[i], start_s_m)) {
        const float gap_m = agent.frenet[i].s_m - (start_s_m + ego_path.frenet.s_m);
        time_s = min(time_s, headway_s(gap_m, ego_mps, agent.track.speed_mps) + handicap_s);
      }
      for (const ConflictZone& zone : ego_path.zones) {
        time_s = min(time_s, zone_time_s(zone, ego_path, agent, i, ego_mps) + handicap_s);
      }
    }
  }
  return time_s;
}

int interaction_work(const Scene& scene, const Agent& agent) {
  int lanes = 0;
  for (const LanePath& path : agent.paths) lanes += path.lanes.size();
  int work = kRankWork;
  for (const EgoPath& ego_path : scene.ego_paths)
    work += kMeetWork + lanes * (ego_path.path.lanes.size() + ego_path.zones.size()) / kPairsPerUnit;
  return work;
}

}  // namespace

int rank_agents(Relevance relevance, const Parameters& parameters, Scene& scene) {
  const float ahead_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  const Point centre = offset_point(scene.ego.rear_axle, ahead_m, 0.0F);
  const int count = scene.agents.size();
  float key[kMaxTracks] = {};
  int work = 0;
  for (int i = 0; i < count; ++i) {
    const Agent& agent = scene.agents[i];
    key[i] = relevance == Relevance::kNearest ? distance(centre, position(agent.track.centre))
                                              : interaction_time_s(scene, agent);
    work += interaction_work(scene, agent);
  }
  scene.watched = count < kMaxAgents ? count : kMaxAgents;
  for (int place = 0; place < scene.watched; ++place) {
    int best = place;
    for (int i = place + 1; i < count; ++i) {
      if (key[i] < key[best]) best = i;
    }
    if (best == place) continue;
    const Agent agent = scene.agents[best];
    const float best_key = key[best];
    work += kMoveWork * (best - place + 2);
    for (int i = best; i > place; --i) {
      scene.agents[i] = scene.agents[i - 1];
      key[i] = key[i - 1];
    }
    scene.agents[place] = agent;
    key[place] = best_key;
  }
  return work;
}

}  // namespace s4tp::scene
