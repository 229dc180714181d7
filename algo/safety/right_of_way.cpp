#include "algo/safety/right_of_way.hpp"

#include "algo/core/math.hpp"

namespace s4tp {
namespace {

constexpr float kBrakingMps2 = -1.0F;  // gentler is no answer to us

/// Whether its present braking, kept up, ends before the zone.
bool is_stopping(const Agent& agent, const Approach& approach) {
  const float braking = agent.track.acceleration_mps2;
  return braking < kBrakingMps2 &&
         square(agent.track.speed_mps) <= -2.0F * braking * max(approach.to_entry_m, 0.0F);
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

}  // namespace s4tp
