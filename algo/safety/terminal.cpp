#include "algo/safety/terminal.hpp"

#include "algo/core/inline.hpp"
#include "algo/safety/change_gaps.hpp"
#include "algo/safety/lane_change.hpp"
#include "algo/safety/right_of_way.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/standing_room.hpp"

namespace s4tp {
namespace {

constexpr float kHorizonS = static_cast<float>(kHorizonSteps) * kStepS;
constexpr float kLineToleranceM = 0.3F;  // standing this far over a stop line still counts as before it
constexpr float kRestToleranceM = 0.02F;
constexpr float kComfortTolerance = 1.1F;  // a stop under way may ask for a little more than comfort
constexpr float kHardMps2 = 6.0F;          // the most a plan may count on to stop
constexpr float kCommittedMps2 = 5.0F;     // who would have to brake harder than this is bound to go
constexpr float kMovingMps = 1.0F;         // slower inside a zone is standing in it
constexpr float kCrawlMps = 2.0F;          // way beyond the horizon is driven no slower
constexpr float kLeaderGapM = 0.3F;        // left when both have stopped
constexpr float kBrakesMps2 = 0.5F;        // who slows down less than this just keeps his speed as drivers do
constexpr float kUsualLaneM = 3.2F;

/// A trajectory seen along its path: arc lengths of the rear axle.
struct Along {
  float s_m[kTrajectoryPoints];
  float start_mps;
  float end_mps;
  [[nodiscard]] float start_s_m() const { return s_m[0]; }
  [[nodiscard]] float end_s_m() const { return s_m[kHorizonSteps]; }
};

void measure(const Scene& scene, const EgoPath& path, float start_s_m, const Trajectory& trajectory,
             Along& along) {
  const TrajectoryPoint& start = trajectory.points[0];
  const TrajectoryPoint& end = trajectory.points[kHorizonSteps];
  along.start_mps = start.speed_mps;
  along.end_mps = end.speed_mps;
  along.s_m[0] = start_s_m;
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
  if (along.end_mps <= 0.05F) return left_m >= -kRestToleranceM;
  const float start_left_m = max(s_m - along.start_s_m(), 0.1F);
  const float demanded_mps2 = min(kHardMps2, square(along.start_mps) / (2.0F * start_left_m));
  const float braking_mps2 = kComfortTolerance * max(parameters.comfort.braking_mps2, demanded_mps2);
  return square(along.end_mps) <= 2.0F * braking_mps2 * left_m;
}

TerminalVerdict blame(TerminalCause cause, int agent = 255) {
  return {cause, static_cast<std::uint8_t>(agent)};
}

/// Everything the zones of one path are judged by.
struct Passing {
  const Scene& scene;
  const EgoPath& path;
  const Along& along;
  const Parameters& parameters;
  float centre_m;             ///< from our rear axle to our box centre
  float under_way_until_s_m;  ///< of our box centre
  TerminalVerdict& verdict;
};

Resolve resolve_for(const Passing& passing, const ConflictZone& zone) {
  const float centre_s_m = passing.along.start_s_m() + passing.centre_m;
  const float to_entry_m = max(zone.entry_s_m - centre_s_m, 0.0F);
  const bool inside = centre_s_m > zone.entry_s_m;
  if (!inside && square(passing.along.start_mps) > 2.0F * kCommittedMps2 * to_entry_m)
    return Resolve::kCommitted;
  return zone.entry_s_m < passing.under_way_until_s_m ? Resolve::kUnderWay : Resolve::kConsidering;
}

/// Where our rear axle may come to rest before the zone.
float hold_s_m(const Passing& passing, const ConflictZone& zone) {
  const Along& along = passing.along;
  const float entry_s_m = zone.entry_s_m - passing.centre_m;
  const float line_s_m = zone.stop_s_m - rear_axle_to_front_m(passing.parameters);
  const float edge_s_m = entry_s_m - kClearOfZoneM;
  const float before_line_s_m = min(line_s_m + kLineToleranceM, edge_s_m);
  if (along.start_s_m() <= before_line_s_m && !waits_beyond_line(passing.scene, line_s_m, along.start_s_m()))
    return before_line_s_m;
  // Over the line there is still the zone to wait for.
  if (along.start_s_m() <= edge_s_m) return edge_s_m;
  // Nearer than that: at once, no creeping.
  return min(along.start_s_m() + square(along.start_mps) / (2.0F * passing.parameters.comfort.braking_mps2),
             entry_s_m);
}

/// Whether one who stands, and would let us go first, stands in our way itself. A crossing under way is not
/// given up for it: the check sees whether it is hit.
bool blocks_way(const Passing& passing, const ConflictZone& zone, int index, Resolve resolve) {
  const Agent& agent = passing.scene.agents[index];
  return resolve == Resolve::kConsidering && is_standing(agent) &&
         !leaves_room(passing.scene, passing.path, agent, passing.along.start_s_m(),
                      zone.exit_s_m - passing.centre_m, passing.parameters);
}

/// Whom we would meet in the zone, and who is trusted to leave it to us. \return false: somebody would be
/// there
bool pass_zone(Passing& passing, const ConflictZone& zone, float in_s, float out_s, bool refuses) {
  const Resolve resolve = resolve_for(passing, zone);
  for (int i = 0; i < passing.scene.agents.size(); ++i) {
    Passage passage = judge_passage(passing.scene, i, zone, in_s, out_s, resolve, passing.parameters);
    if (passage == Passage::kTrusted && refuses && blocks_way(passing, zone, i, resolve))
      passage = Passage::kRefused;
    if (passage == Passage::kTrusted) passing.verdict.trusted |= static_cast<std::uint16_t>(1U << i);
    if (passage != Passage::kRefused || !refuses) continue;
    passing.verdict.cause = TerminalCause::kZone;
    passing.verdict.agent = static_cast<std::uint8_t>(i);
    passing.verdict.arrives_s = earliest_arrival_s(passing.scene, i, zone, passing.parameters);
    const bool we_wait = zone.priority != Priority::kFirstHasPriority && resolve != Resolve::kCommitted;
    passing.verdict.needed_s =
        out_s + (we_wait ? zone_margin_s(passing.scene, resolve, passing.parameters) : 0.0F);
    return false;
  }
  return true;
}

bool judge_zone(Passing& passing, const ConflictZone& zone) {
  const Along& along = passing.along;
  const float entry_s_m = zone.entry_s_m - passing.centre_m;
  const float exit_s_m = zone.exit_s_m - passing.centre_m;
  if (along.start_s_m() >= exit_s_m) return true;
  const float out_s = time_at(along, exit_s_m);
  if (along.start_s_m() > entry_s_m) return pass_zone(passing, zone, 0.0F, out_s, false);  // inside already
  if (stops_before(along, hold_s_m(passing, zone), passing.parameters)) return true;
  if (along.end_s_m() < exit_s_m && along.end_mps < kMovingMps) {
    passing.verdict.cause = TerminalCause::kStopsInZone;
    return false;
  }
  return pass_zone(passing, zone, time_at(along, entry_s_m), out_s, true);
}

/// Way left between us and the leader when both have stopped, it at b_max from the horizon's end on.
bool leader_safe(const EgoPath& path, const Leader& leader, const Along& along, bool begins,
                 const Parameters& parameters) {
  if (leader.agent < 0) return true;
  const float change_mps2 = leader.acceleration_mps2 < -kBrakesMps2 ? leader.acceleration_mps2 : 0.0F;
  const float later_mps = max(0.0F, leader.speed_mps + change_mps2 * kHorizonS);
  const float its_way_m = later_mps > 0.0F || leader.speed_mps <= 0.0F
                              ? 0.5F * (leader.speed_mps + later_mps) * kHorizonS
                              : square(leader.speed_mps) / (-2.0F * change_mps2);
  // Until our plan starts it drives on, too.
  const float lead_share = leader.speed_mps / max(max(leader.speed_mps, along.start_mps), kCrawlMps);
  const float lead_m = max(0.0F, along.start_s_m() - path.frenet.s_m) * lead_share;
  const float end_gap_m = leader.gap_m + lead_m + its_way_m - (along.end_s_m() - path.frenet.s_m);
  if (begins) return end_gap_m >= change_gap_to_leader_m(along.end_mps, later_mps, parameters);
  const float left_m = end_gap_m + square(later_mps) / (2.0F * parameters.rss.braking_max_mps2) -
                       square(along.end_mps) / (2.0F * kHardMps2);
  // A leader who cut in may have left less than that already: then it only must not get worse.
  const float now_m = leader.gap_m + square(leader.speed_mps) / (2.0F * parameters.rss.braking_max_mps2) -
                      square(along.start_mps) / (2.0F * kHardMps2);
  return left_m >= min(kLeaderGapM, now_m);
}

/// A lane change must not make the one behind, in the lane we come to, brake hard.
bool follower_safe(const Leader& follower, const Along& along, const Parameters& parameters) {
  if (follower.agent < 0) return true;
  // A drive harder than comfort may lag behind its plan: it is not counted on.
  const float end_mps =
      min(along.end_mps, along.start_mps + parameters.comfort.acceleration_mps2 * kHorizonS);
  const float way_m =
      min(along.end_s_m() - along.start_s_m(), 0.5F * (along.start_mps + end_mps) * kHorizonS);
  const float gap_m = follower.gap_m + way_m - follower.speed_mps * kHorizonS;
  return gap_m >= change_gap_to_follower_m(end_mps, follower.speed_mps, parameters);
}

bool knows_path(const Scene& scene, int path) {
  return scene.map != nullptr && path >= 0 && path < scene.ego_paths.size();
}

}  // namespace

PathSight look_along(const Scene& scene, int path_index, const TrajectoryPoint& start,
                     const Parameters& parameters) {
  PathSight sight;
  if (!knows_path(scene, path_index)) return sight;
  const EgoPath& path = scene.ego_paths[path_index];
  sight.start_s_m = project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 15.0F).s_m;
  sight.changes = changes_lane(scene, path);
  if (sight.changes) {
    sight.under_way = change_under_way(scene, path, start, parameters);
    sight.neighbours = find_neighbours(scene, path, parameters);
  } else {
    sight.neighbours.leader = find_leader(scene, path, path.frenet.s_m, parameters);
  }
  return sight;
}

TerminalVerdict judge_terminal(const Scene& scene, int path_index, const Trajectory& trajectory,
                               const Parameters& parameters) {
  const PathSight sight = look_along(scene, path_index, trajectory.points[0], parameters);
  return judge_terminal(scene, path_index, sight, trajectory, parameters);
}

TerminalVerdict judge_terminal(const Scene& scene, int path_index, const PathSight& sight,
                               const Trajectory& trajectory, const Parameters& parameters) {
  if (!knows_path(scene, path_index)) return blame(TerminalCause::kNoPath);
  const EgoPath& path = scene.ego_paths[path_index];
  Along along;
  measure(scene, path, sight.start_s_m, trajectory, along);

  const float end_of_road_m = dead_end_s_m(scene, path) - rear_axle_to_front_m(parameters);
  // With the bumper over the end of the road already, what is left is to stop at once.
  const float at_once_m =
      along.start_s_m() + square(along.start_mps) / (2.0F * parameters.comfort.braking_mps2);
  if (!stops_before(along, max(end_of_road_m, at_once_m), parameters)) return blame(TerminalCause::kRoadEnd);
  const bool under_way = sight.under_way;
  // Where the road ends in the wrong lane, room is left to change lanes from rest. Who is past that stops at
  // once, for what is left is better than nothing; but a change under way is finished before: nobody is to
  // stand astride two lanes.
  const float astride = min(1.0F, abs(path.frenet.d_m) / kUsualLaneM);
  const float finished_m = along.start_s_m() + astride * kChangeWayM;
  const float last_change_m = max(end_of_road_m - change_room_m(scene, path), finished_m);
  if (!under_way && !stops_before(along, max(last_change_m, at_once_m), parameters)) {
    return blame(TerminalCause::kLaneEnd);
  }
  TerminalVerdict verdict;
  const float centre_m = rear_axle_to_centre_m(parameters);
  Passing passing{
      scene,    path,
      along,    parameters,
      centre_m, under_way_until_s_m(path, along.start_s_m() + centre_m, along.start_mps, parameters),
      verdict};
  for (const ConflictZone& zone : path.zones) {
    if (!judge_zone(passing, zone)) return verdict;
  }
  const auto& [leader, follower, joins_beside] = sight.neighbours;
  if (!sight.changes) {
    return leader_safe(path, leader, along, false, parameters) ? verdict
                                                               : blame(TerminalCause::kLeader, leader.agent);
  }
  // To brake for who joins it at the same time is to stay beside him: who is under way goes on.
  if (!under_way && joins_beside >= 0) return blame(TerminalCause::kFollower, joins_beside);
  if (!leader_safe(path, leader, along, !under_way && !path.bound_for, parameters))
    return blame(TerminalCause::kLeader, leader.agent);
  const bool follower_stays = under_way && can_stay_behind(follower.gap_m, follower.speed_mps, trajectory);
  if (!follower_stays && !follower_safe(follower, along, parameters))
    return blame(TerminalCause::kFollower, follower.agent);
  return verdict;
}

}  // namespace s4tp
