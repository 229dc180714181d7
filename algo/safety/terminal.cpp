#include "algo/safety/terminal.hpp"

#include "algo/core/math.hpp"
#include "algo/safety/right_of_way.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp {
namespace {

constexpr float kNever = 1e3F;  // s
constexpr float kHorizonS = static_cast<float>(kHorizonSteps) * kStepS;
constexpr float kLineToleranceM = 0.3F;    // standing this far over a stop line still counts as before it
constexpr float kComfortTolerance = 1.1F;  // a stop under way may ask for a little more than comfort
constexpr float kHardMps2 = 6.0F;          // the most a plan may count on to stop
constexpr float kCommittedMps2 = 5.0F;     // who would have to brake harder than this is bound to go
constexpr float kMovingMps = 1.0F;         // slower inside a zone is standing in it
constexpr float kCrawlMps = 2.0F;          // way beyond the horizon is driven no slower
constexpr float kPassedFirstS = 0.3F;      // others who clear a zone this long before we enter it went first
constexpr float kSlowing = 0.8F;           // of their present speed, in that judgement
constexpr float kBesideS = 0.5F;           // between us and one who should yield but will not
constexpr float kLeaderGapM = 0.3F;        // left when both have stopped
constexpr float kBlockedGapM = 8.0F;       // a leader this near explains why we stand in a zone
constexpr float kFollowerBrakingMps2 = 2.5F;  // a lane change may ask this of the one behind
constexpr float kFollowerHeadwayS = 0.6F;
constexpr float kFollowerGapM = 2.5F;

/// A trajectory seen along its path: arc lengths of the rear axle.
struct Along {
  float s_m[kTrajectoryPoints];
  float start_mps;
  float end_mps;
  [[nodiscard]] float start_s_m() const { return s_m[0]; }
  [[nodiscard]] float end_s_m() const { return s_m[kHorizonSteps]; }
};

void measure(const Scene& scene, const EgoPath& path, const Trajectory& trajectory, Along& along) {
  const TrajectoryPoint& start = trajectory.points[0];
  const TrajectoryPoint& end = trajectory.points[kHorizonSteps];
  along.start_mps = start.speed_mps;
  along.end_mps = end.speed_mps;
  along.s_m[0] = project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 15.0F).s_m;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const float mean_mps = 0.5F * (trajectory.points[i - 1].speed_mps + trajectory.points[i].speed_mps);
    along.s_m[i] = along.s_m[i - 1] + mean_mps * kStepS;
  }
  const float driven_m = along.end_s_m() - along.start_s_m();
  if (driven_m < 0.1F) return;
  // Offsets and bends make our way a little longer or shorter than the path's: scale to the true end.
  const float end_s_m = project(*scene.map, path.path, position(end.rear_axle), along.end_s_m(), 15.0F).s_m;
  const float scale = (end_s_m - along.start_s_m()) / driven_m;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    along.s_m[i] = along.start_s_m() + scale * (along.s_m[i] - along.start_s_m());
  }
}

/// When the trajectory, driven on at its end speed, comes to `s_m`.
float time_at(const Along& along, float s_m) {
  if (s_m > along.end_s_m()) return kHorizonS + (s_m - along.end_s_m()) / max(along.end_mps, kCrawlMps);
  int i = 0;
  while (i < kHorizonSteps && along.s_m[i] < s_m) ++i;
  return static_cast<float>(i) * kStepS;
}

/// Whether the end can stop before `s_m`: comfortably, or as hard as the start already demanded.
bool stops_before(const Along& along, float s_m, const Parameters& parameters) {
  const float left_m = s_m - along.end_s_m();
  if (along.end_mps <= 0.05F) return left_m >= -kLineToleranceM;
  const float start_left_m = max(s_m - along.start_s_m(), 0.1F);
  const float demanded_mps2 = min(kHardMps2, square(along.start_mps) / (2.0F * start_left_m));
  const float braking_mps2 = kComfortTolerance * max(parameters.comfort.braking_mps2, demanded_mps2);
  return square(along.end_mps) <= 2.0F * braking_mps2 * left_m;
}

/// Whether one other vehicle leaves us the zone between `in_s` and `out_s`.
bool leaves_zone_to_us(const Scene& scene, int index, const ConflictZone& zone, float in_s, float out_s,
                       bool committed, const Parameters& parameters) {
  const Agent& agent = scene.agents[index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches) return true;
  const float speed_mps = agent.track.speed_mps;
  if (speed_mps > kMovingMps && approach.to_exit_m / (kSlowing * speed_mps) + kPassedFirstS < in_s)
    return true;
  if (approach.to_entry_m <= 0.0F) return false;

  const float arrival_s = earliest_arrival_s(scene, index, zone, parameters);
  const bool we_yield =
      zone.priority == Priority::kFirstYields || (zone.priority == Priority::kFirstCome && arrival_s < in_s);
  if (we_yield && !committed) return arrival_s > out_s + parameters.safety.zone_margin_s;
  // It owes us the way, or we can no longer stop: will it, at its present speed, be there while we are?
  if (!we_yield && can_stop_for_us(agent, approach)) return true;
  return speed_mps < kMovingMps || approach.to_entry_m / speed_mps > out_s + kBesideS;
}

bool zone_safe(const Scene& scene, const EgoPath& path, const ConflictZone& zone, const Along& along,
               const Parameters& parameters) {
  const float centre_m = rear_axle_to_centre_m(parameters);
  const float entry_s_m = zone.entry_s_m - centre_m;
  const float exit_s_m = zone.exit_s_m - centre_m;
  if (along.start_s_m() >= exit_s_m) return true;
  if (along.start_s_m() > entry_s_m) {  // already inside: leave it
    if (along.end_s_m() >= exit_s_m || along.end_mps >= kMovingMps) return true;
    const Leader leader = find_leader(scene, path, path.frenet.s_m, parameters);
    return leader.agent >= 0 && leader.gap_m < kBlockedGapM;
  }
  const float line_s_m = zone.stop_s_m - rear_axle_to_front_m(parameters);
  const bool over_line = along.start_s_m() > line_s_m + kLineToleranceM;
  const float hold_s_m = over_line ? entry_s_m : min(line_s_m + kLineToleranceM, entry_s_m);
  if (stops_before(along, hold_s_m, parameters)) return true;
  if (along.end_s_m() < exit_s_m && along.end_mps < kMovingMps) return false;  // would stand in it

  const bool committed =
      square(along.start_mps) > 2.0F * kCommittedMps2 * max(entry_s_m - along.start_s_m(), 0.0F);
  const float in_s = time_at(along, entry_s_m);
  const float out_s = time_at(along, exit_s_m);
  for (int i = 0; i < scene.agents.size(); ++i) {
    if (!leaves_zone_to_us(scene, i, zone, in_s, out_s, committed, parameters)) return false;
  }
  return true;
}

/// Way left between us and the leader when both have stopped, it at b_max from the horizon's end on.
bool leader_safe(const Scene& scene, const EgoPath& path, const Along& along, const Parameters& parameters) {
  const Leader leader = find_leader(scene, path, path.frenet.s_m, parameters);
  if (leader.agent < 0) return true;
  const float later_mps = max(0.0F, leader.speed_mps + min(0.0F, leader.acceleration_mps2) * kHorizonS);
  const float braking = min(leader.acceleration_mps2, -0.1F);
  const float its_way_m = later_mps > 0.0F || leader.speed_mps <= 0.0F
                              ? 0.5F * (leader.speed_mps + later_mps) * kHorizonS
                              : square(leader.speed_mps) / (-2.0F * braking);
  const float stop_m = square(later_mps) / (2.0F * parameters.rss.braking_max_mps2);
  const float own_stop_m = square(along.end_mps) / (2.0F * kHardMps2);
  const float own_way_m = along.end_s_m() - path.frenet.s_m;
  const float left_m = leader.gap_m + its_way_m + stop_m - own_way_m - own_stop_m;
  // A leader who cut in may have left less than that already: then it only must not get worse.
  const float now_m = leader.gap_m + square(leader.speed_mps) / (2.0F * parameters.rss.braking_max_mps2) -
                      square(along.start_mps) / (2.0F * kHardMps2);
  return left_m >= min(kLeaderGapM, now_m);
}

/// A lane change must not make the one behind, in the lane we come to, brake hard.
bool follower_safe(const Scene& scene, const EgoPath& path, const Along& along,
                   const Parameters& parameters) {
  const Frenet& frenet = path.frenet;
  const float width_m = path_point(*scene.map, path.path, frenet.s_m).width_m;
  if (path.manoeuvre == Manoeuvre::kKeep || abs(frenet.d_m) < 0.5F * width_m) return true;
  const Leader follower = find_follower(scene, path, frenet.s_m, parameters);
  if (follower.agent < 0) return true;
  const float gap_m = follower.gap_m + (along.end_s_m() - frenet.s_m) - follower.speed_mps * kHorizonS;
  if (gap_m < kFollowerGapM + kFollowerHeadwayS * follower.speed_mps) return false;
  const float faster_mps = max(0.0F, follower.speed_mps - along.end_mps);
  return square(faster_mps) <= 2.0F * kFollowerBrakingMps2 * (gap_m - kFollowerGapM);
}

}  // namespace

float earliest_arrival_s(const Scene& scene, int agent_index, const ConflictZone& zone,
                         const Parameters& parameters) {
  const Agent& agent = scene.agents[agent_index];
  const Approach approach = approach_to(agent, zone);
  if (!approach.reaches || scene.map == nullptr) return kNever;
  const float way_m = approach.to_entry_m;
  if (way_m <= 0.0F) return 0.0F;
  float limit_mps = scene.map->lanes[zone.other_lane].speed_limit_mps;
  if (agent.lane != kNoLaneIndex) limit_mps = max(limit_mps, scene.map->lanes[agent.lane].speed_limit_mps);
  const float speed_mps = agent.track.speed_mps;
  const float top_mps = max(max(limit_mps * parameters.safety.over_limit, speed_mps), 0.1F);
  const float gain_mps2 = parameters.rss.acceleration_mps2;
  const float gaining_s = (top_mps - speed_mps) / gain_mps2;
  const float gaining_m = 0.5F * (top_mps + speed_mps) * gaining_s;
  if (way_m >= gaining_m) return min(kNever, gaining_s + (way_m - gaining_m) / top_mps);
  return (sqrt(square(speed_mps) + 2.0F * gain_mps2 * way_m) - speed_mps) / gain_mps2;
}

bool terminal_safe(const Scene& scene, int path_index, const Trajectory& trajectory,
                   const Parameters& parameters) {
  if (scene.map == nullptr || path_index < 0 || path_index >= scene.ego_paths.size()) return false;
  const EgoPath& path = scene.ego_paths[path_index];
  Along along;
  measure(scene, path, trajectory, along);

  const float end_of_road_m = dead_end_s_m(scene, path) - rear_axle_to_front_m(parameters);
  if (along.start_s_m() < end_of_road_m && !stops_before(along, end_of_road_m, parameters)) return false;
  for (const ConflictZone& zone : path.zones) {
    if (!zone_safe(scene, path, zone, along, parameters)) return false;
  }
  return leader_safe(scene, path, along, parameters) && follower_safe(scene, path, along, parameters);
}

}  // namespace s4tp
