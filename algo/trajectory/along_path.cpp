#include "algo/trajectory/along_path.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kInOwnLaneM = 0.6F;      // nearer to its own lane's centre it is not in ours
constexpr float kOverhangingM = 10.0F;   // vehicles as long as that reach out of their lanes in bends
constexpr float kTouchM = 0.1F;          // our box may be off its line by as much
constexpr float kCrossingCos = 0.7071F;  // 45 degrees
constexpr float kMovingMps = 1.5F;
constexpr float kSweepM = 0.75F;
constexpr int kMostSweeps = 44;  // the longest vehicle and ours
constexpr float kFarM = 200.0F;
constexpr float kAtGoalM = 2.0F;  // a goal at the very end of a road counts as on it

// Work (WorkMeter's units).
constexpr int kSeeWork = 7;
constexpr int kSweepWork = 7;

/// A vehicle near the centre of a plain lane that is none of the path's is not in its strip, unless it stands where our box
/// comes.
bool keeps_beside(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent) {
  if (agent.lane == kNoLaneIndex || agent.paths.empty()) return false;
  if (scene.map->lanes[agent.lane].in_junction) return false;
  float start_s_m = 0.0F;
  return !lane_start(path.path, agent.lane, start_s_m) && abs(agent.frenet[0].d_m) < kInOwnLaneM &&
         agent.track.length_m < kOverhangingM;
}

/// Whether the vehicle's lane leaves the path at a fork.
bool forks_off(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent) {
  if (agent.lane == kNoLaneIndex || scene::is_along(path.path, agent.lane)) return false;
  for (const scene::PathLane& ours : path.path.lanes) {
    for (const LaneIndex successor : scene.map->lanes[ours.lane].successors) {
      if (successor == agent.lane) return true;
    }
  }
  return false;
}

/// Whether our box, driven along the path, comes within `gap_m` of a vehicle that stands.
bool sweeps(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent, float gap_m,
            const Parameters& parameters, OnPath& seen) {
  const Box other{agent.track.centre, agent.track.length_m, agent.track.width_m};
  const float from_s_m = seen.centre_s_m - seen.half_length_m - rear_axle_to_front_m(parameters);
  const float to_s_m = seen.centre_s_m + seen.half_length_m + parameters.vehicle.rear_overhang_m;
  scene::PathCursor cursor(*scene.map, path.path);
  bool touches = false;
  for (int i = 0; i < kMostSweeps && !touches; ++i) {
    const float s_m = from_s_m + static_cast<float>(i) * kSweepM;
    if (s_m > to_s_m) break;
    seen.work += kSweepWork;
    const Pose line = path.driven != nullptr ? reference_at(*path.driven, s_m).pose : cursor.at(s_m).pose;
    const Point there = offset_point(line, 0.0F, path.lateral_offset_m);
    const Box ours = ego_box({there.x_m, there.y_m, line.heading_rad}, parameters);
    touches = separation(ours, other) < gap_m;
  }
  seen.work += scene::kSeekWork * cursor.seeks();
  return touches;
}

/// Whether the vehicle is still before the path's first lane, on a path that leads into it: seen along
/// that one then. (A lane's start is no end of the world: who comes along behind it follows us all the same.)
bool comes_up_behind(const scene::EgoPath& path, const scene::Agent& agent, OnPath& seen, float& error_rad) {
  if (path.path.lanes.empty()) return false;
  for (int i = 0; i < agent.paths.size(); ++i) {
    float start_s_m = 0.0F;
    if (!lane_start(agent.paths[i], path.path.lanes[0].lane, start_s_m)) continue;
    if (agent.frenet[i].s_m >= start_s_m) return false;  // in the first lane already
    seen.centre_s_m = agent.frenet[i].s_m - start_s_m;
    seen.centre_d_m = agent.frenet[i].d_m;
    error_rad = wrap_angle(agent.track.centre.heading_rad - agent.frenet[i].heading_rad);
    return true;
  }
  return false;
}

}  // namespace

bool lane_start(const scene::LanePath& way, LaneIndex lane, float& start_s_m) {
  for (const scene::PathLane& entry : way.lanes) {
    if (entry.lane != lane) continue;
    start_s_m = entry.start_s_m;
    return true;
  }
  return false;
}

OnPath see_on_path(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent,
                   const Parameters& parameters, bool whole_road, bool& known) {
  OnPath seen;
  seen.work = kSeeWork;
  known = false;
  if (distance(position(agent.track.centre), position(scene.ego.rear_axle)) > kFarM) return seen;
  float error_rad = 0.0F;
  bool beside = false;
  if (whole_road || !comes_up_behind(path, agent, seen, error_rad)) {
    beside = !whole_road && keeps_beside(scene, path, agent);
    if (beside && agent.track.speed_mps >= kStandingMps) return seen;
    const scene::Frenet frenet = scene::project(*scene.map, path.path, position(agent.track.centre),
                                                path.frenet.s_m, -1.0F, seen.work);
    error_rad = wrap_angle(agent.track.centre.heading_rad - frenet.heading_rad);
    seen.centre_s_m = frenet.s_m;
    seen.centre_d_m = frenet.d_m;
  }
  const float cosine = cos(error_rad);
  const float signed_sine = sin(error_rad);
  const float sine = abs(signed_sine);
  seen.half_length_m = 0.5F * (abs(cosine) * agent.track.length_m + sine * agent.track.width_m);
  seen.half_width_m = 0.5F * (abs(cosine) * agent.track.width_m + sine * agent.track.length_m);
  seen.along_mps = agent.track.speed_mps * cosine;
  seen.left_mps = agent.track.speed_mps * signed_sine;
  seen.crossing =
      cosine < kCrossingCos && agent.track.speed_mps > kMovingMps && !forks_off(scene, path, agent);
  seen.overlaps = abs(seen.centre_d_m) < 0.5F * parameters.vehicle.width_m + seen.half_width_m + kStripM;
  // Along the path its strip tells; across or against it boxes do: in a bend they pass where strips overlap.
  if (seen.overlaps && (beside || (cosine < kCrossingCos && !seen.crossing)))
    seen.overlaps = sweeps(scene, path, agent, beside ? kTouchM : kStripM, parameters, seen);
  known = !beside || seen.overlaps;
  return seen;
}

bool joins(const scene::Scene& scene, const scene::EgoPath& path, const scene::Agent& agent) {
  if (agent.lane == kNoLaneIndex || scene::is_along(path.path, agent.lane)) return false;
  const Lane& own = scene.map->lanes[agent.lane];
  for (const scene::LanePath& theirs : agent.paths) {
    if (theirs.lanes.empty()) continue;
    const LaneIndex lane = theirs.lanes[0].lane;
    if ((lane == own.left || lane == own.right) && scene::is_along(path.path, lane)) return true;
  }
  return false;
}

Leader find_leader(const scene::Scene& scene, const scene::EgoPath& path, float rear_axle_s_m,
                   const Parameters& parameters) {
  const float centre_s_m = rear_axle_s_m + rear_axle_to_centre_m(parameters);
  const float front_s_m = rear_axle_s_m + rear_axle_to_front_m(parameters);
  Leader leader;
  int work = 0;
  for (int i = 0; i < scene.agents.size(); ++i) {
    bool known = false;
    const OnPath seen = see_on_path(scene, path, scene.agents[i], parameters, false, known);
    work += seen.work;
    if (!known || !seen.overlaps || seen.crossing || seen.centre_s_m <= centre_s_m) continue;
    const float gap_m = seen.centre_s_m - seen.half_length_m - front_s_m;
    if (leader.agent >= 0 && gap_m >= leader.gap_m) continue;
    leader = {i, gap_m, max(0.0F, seen.along_mps), scene.agents[i].track.acceleration_mps2};
  }
  leader.work = work;
  return leader;
}

Leader find_follower(const scene::Scene& scene, const scene::EgoPath& path, float rear_axle_s_m,
                     const Parameters& parameters) {
  const float centre_s_m = rear_axle_s_m + rear_axle_to_centre_m(parameters);
  const float rear_s_m = rear_axle_s_m - parameters.vehicle.rear_overhang_m;
  Leader follower;
  int work = 0;
  for (int i = 0; i < scene.agents.size(); ++i) {
    bool known = false;
    const OnPath seen = see_on_path(scene, path, scene.agents[i], parameters, false, known);
    work += seen.work;
    if (!known || !seen.overlaps || seen.crossing || seen.centre_s_m > centre_s_m) continue;
    if (seen.along_mps < 0.0F) continue;
    const float gap_m = rear_s_m - (seen.centre_s_m + seen.half_length_m);
    if (follower.agent >= 0 && gap_m >= follower.gap_m) continue;
    follower = {i, gap_m, seen.along_mps, scene.agents[i].track.acceleration_mps2};
  }
  follower.work = work;
  return follower;
}

float change_room_m(const scene::Scene& scene, const scene::EgoPath& path) {
  if (path.path.lanes.empty()) return 0.0F;
  const Lane& last = scene.map->lanes[path.path.lanes[path.path.lanes.size() - 1].lane];
  float changes_m = 0.0F;
  for (const float by_s_m : path.change_by_s_m) {
    if (by_s_m < path.path.length_m + kAtGoalM) changes_m = changes_m + scene::kChangeWayM;
  }
  // Only the last lane itself can be left sideways: half of it is to be driven on in any case.
  return min(changes_m, 0.5F * last.length_m);
}

float dead_end_s_m(const scene::Scene& scene, const scene::EgoPath& path) {
  const scene::LanePath& lane_path = path.path;
  if (lane_path.lanes.empty() || lane_path.lanes.full()) return kNoDeadEndM;
  const Lane& last = scene.map->lanes[lane_path.lanes[lane_path.lanes.size() - 1].lane];
  const bool leads_to_goal = last.on_route && last.changes_needed == 0;
  if (leads_to_goal && path.goal_s_m <= lane_path.length_m + kAtGoalM) return kNoDeadEndM;
  for (const LaneIndex successor : last.successors) {
    if (successor != kNoLaneIndex) return kNoDeadEndM;
  }
  return lane_path.length_m;
}

}  // namespace s4tp::trajectory
