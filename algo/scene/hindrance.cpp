#include "algo/scene/hindrance.hpp"

#include "algo/core/inline.hpp"
#include "algo/scene/agent_paths.hpp"
#include "algo/scene/conflict_view.hpp"

namespace s4tp {
namespace {

constexpr float kAheadM = 40.0F;      // zones further on are not what it stands for
constexpr float kJustPassedM = 5.0F;  // beyond the zone: seen to be gone only now
constexpr float kComingS = 5.0F;      // who needs longer leaves everybody time to go
constexpr float kUsualMps = 4.0F;     // arrival times are taken at no less than this speed
constexpr float kStandingMps = 0.3F;

/// Whether the vehicle is on its way to `lane`'s stretch, or on it.
bool comes(const Agent& agent, LaneIndex lane, float entry_m, float exit_m) {
  const float reach_m = kComingS * max(agent.track.speed_mps, kUsualMps);
  for (int k = 0; k < agent.paths.size(); ++k) {
    for (const PathLane& part : agent.paths[k].lanes) {
      if (part.lane != lane) continue;
      const float to_entry_m = part.start_s_m + entry_m - agent.frenet[k].s_m;
      const float to_exit_m = part.start_s_m + exit_m - agent.frenet[k].s_m;
      if (to_exit_m > -kJustPassedM && to_entry_m < reach_m) return true;
    }
  }
  return false;
}

bool somebody_comes(const Scene& scene, int index, const ConflictView& view) {
  for (int i = 0; i < scene.agents.size(); ++i) {
    const Agent& other = scene.agents[i];
    if (i == index || other.track.speed_mps < kStandingMps) continue;
    if (comes(other, view.other, view.other_entry_m, view.other_exit_m)) return true;
  }
  return false;
}

}  // namespace

bool waits_for_somebody(const Scene& scene, int index) {
  const Agent& agent = scene.agents[index];
  for (int k = 0; k < agent.paths.size(); ++k) {
    if (agent.path_probability[k] < kLikelyWay) continue;
    const LanePath& path = agent.paths[k];
    std::int8_t place[kMaxLanes];
    for (std::int8_t& entry : place) entry = -1;
    for (int i = 0; i < path.lanes.size(); ++i) place[path.lanes[i].lane] = static_cast<std::int8_t>(i);
    for (const Conflict& conflict : scene.map->conflicts) {
      if (!sound(conflict)) continue;
      const bool from_second = place[conflict.second] >= 0;
      if ((place[conflict.first] >= 0) == from_second) continue;
      const ConflictView view = view_from(conflict, from_second);
      if (view.priority == Priority::kFirstHasPriority) continue;
      const float lane_start_m = path.lanes[place[view.own]].start_s_m - agent.frenet[k].s_m;
      const bool ahead = lane_start_m + view.own_exit_m > 0.0F && lane_start_m + view.own_entry_m < kAheadM;
      if (ahead && somebody_comes(scene, index, view)) return true;
    }
  }
  return false;
}

}  // namespace s4tp
