#include "algo/safety/minimum_risk.hpp"

#include "algo/core/inline.hpp"
#include "algo/safety/lane_change.hpp"
#include "algo/safety/legal_occupancy.hpp"
#include "algo/safety/rss.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/path_walk.hpp"
#include "algo/trajectory/roll_out.hpp"
#include "algo/trajectory/speed_profile.hpp"

namespace s4tp {
namespace {

constexpr float kGapM = 1.0F;         // left to a standing leader
constexpr float kBeforeZoneM = 0.2F;  // stops in a zone become stops before it, if no harder than this:
constexpr float kForZoneMps2 = 8.0F;
constexpr float kBeyondZoneM = 0.5F;  // clear of a zone we leave
constexpr float kLeavingMps2 = 2.0F;  // drive used to leave it
constexpr float kBesideM = 0.4F;      // without a map: who is this near to our way ahead is in it
constexpr float kBuildUpS = 0.1F;     // at speed, until braking has built up
constexpr float kStretch = 1.7F;
constexpr int kStretches = 3;
constexpr float kInLaneM = 0.6F;    // nearer to a lane's centre we are in it for good
constexpr float kAstrideM = 1.1F;   // more, and half a lane lies between us and any lane
constexpr float kWayAcross = 5.0F;  // way along the lane for each metre to its centre
constexpr float kSoftestMps2 = 0.5F;
constexpr float kSoftestBehindMps2 = 1.5F;  // in front of somebody: we do come to rest
constexpr float kNoticeS = 0.5F;            // until the one behind brakes
constexpr float kBesideUsM = 1e3F;          // short of the safe distance by more than anybody behind

/// Braking that stops within `way_m`, its build-up counted in.
float needed_mps2(float speed_mps, float way_m) {
  return square(speed_mps) / (2.0F * max(way_m - kBuildUpS * speed_mps, 0.1F));
}

/// The same, at least `braking_mps2`, at most what the car can.
float harder(float braking_mps2, float speed_mps, float way_m, const Parameters& parameters) {
  const float most_mps2 = max(braking_mps2, parameters.vehicle.braking_max_mps2);
  return clamp(needed_mps2(speed_mps, way_m), braking_mps2, most_mps2);
}

/// Way until we must stand, behind somebody `gap_m` ahead who may brake as we do.
float way_behind(float gap_m, float leader_mps, float leader_mps2, const Parameters& parameters) {
  const float braking = max(parameters.safety.minimum_risk_braking_mps2, -leader_mps2);
  return gap_m - kGapM + square(leader_mps) / (2.0F * braking);
}

/// Without a lane: whoever is straight ahead.
float braking_straight_ahead(const Scene& scene, const TrajectoryPoint& start, const Parameters& parameters) {
  const Pose front = shift_ahead(start.rear_axle, rear_axle_to_front_m(parameters));
  float braking = parameters.safety.minimum_risk_braking_mps2;
  for (const Agent& agent : scene.agents) {
    const Track& track = agent.track;
    const Point local = to_local(front, position(track.centre));
    const float turned_rad = track.centre.heading_rad - front.heading_rad;
    const float along = cos(turned_rad);
    const float across = abs(sin(turned_rad));
    const float half_length_m = 0.5F * (abs(along) * track.length_m + across * track.width_m);
    const float half_width_m = 0.5F * (abs(along) * track.width_m + across * track.length_m);
    if (abs(local.y_m) > 0.5F * parameters.vehicle.width_m + half_width_m + kBesideM) continue;
    if (local.x_m < -half_length_m) continue;
    const float way_m = way_behind(local.x_m - half_length_m, max(0.0F, track.speed_mps * along),
                                   track.acceleration_mps2, parameters);
    braking = max(braking, harder(braking, start.speed_mps, way_m, parameters));
  }
  return braking;
}

/// Time to drive `way_m` with kLeavingMps2.
float driving_time_s(float way_m, float speed_mps) {
  return (sqrt(square(speed_mps) + 2.0F * kLeavingMps2 * way_m) - speed_mps) / kLeavingMps2;
}

/// By how much who is behind in the lane of the path is nearer to us than is safe; more when somebody is
/// beside us there.
float in_the_way_m(const Neighbours& others, float speed_mps, const Parameters& parameters) {
  const auto& [leader, follower, joins_beside] = others;
  const bool beside = joins_beside >= 0 || (leader.agent >= 0 && leader.gap_m < 0.0F) ||
                      (follower.agent >= 0 && follower.gap_m < 0.0F);
  if (beside) return kBesideUsM;
  if (follower.agent < 0) return 0.0F;
  return max(0.0F, safe_distance_m(follower.speed_mps, speed_mps, parameters) - follower.gap_m);
}

/// The ego path to stop on: of the lanes we are in or bound for, the one where we are least in others' way,
/// then the nearest one.
int path_to_stop_on(const Scene& scene, const TrajectoryPoint& start, const Parameters& parameters) {
  int best = -1;
  float least_m = 0.0F;
  for (int i = 0; i < scene.ego_paths.size(); ++i) {
    const EgoPath& path = scene.ego_paths[i];
    if (!change_under_way(scene, path, start, parameters)) continue;
    const Neighbours others = find_neighbours(scene, path, parameters);
    const float here_m = in_the_way_m(others, start.speed_mps, parameters);
    const bool nearer = best >= 0 && abs(path.frenet.d_m) < abs(scene.ego_paths[best].frenet.d_m);
    if (best >= 0 && (here_m > least_m || (here_m == least_m && !nearer))) continue;
    best = i;
    least_m = here_m;
  }
  return best < 0 ? 0 : best;
}

/// The hardest braking that lets us come into the lane first, and the one behind us there stop in time.
float braking_into_lane(const Scene& scene, const EgoPath& path, float speed_mps,
                        const Parameters& parameters) {
  const float braking_mps2 = parameters.safety.minimum_risk_braking_mps2;
  const float aside_m = abs(path.frenet.d_m) - kInLaneM;
  if (aside_m <= 0.0F || aside_m > kAstrideM) return braking_mps2;  // in it, or no lane change
  const float across_mps2 = max(kSoftestMps2, square(speed_mps) / (2.0F * kWayAcross * aside_m));
  const Leader follower = find_neighbours(scene, path, parameters).follower;
  if (follower.agent < 0) return min(across_mps2, braking_mps2);
  const float its_way_m =
      follower.speed_mps * kNoticeS + square(follower.speed_mps) / (2.0F * kFollowerBrakingMps2);
  const float left_m = max(its_way_m + kGapM - follower.gap_m, kGapM);
  const float behind_mps2 = max(kSoftestBehindMps2, square(speed_mps) / (2.0F * left_m));
  return min(min(across_mps2, behind_mps2), braking_mps2);
}

/// Whether everybody lets us drive on by `way_m`, through all zones we touch on it.
bool may_leave(const Scene& scene, const EgoPath& path, float s_m, float way_m, float speed_mps,
               const Parameters& parameters) {
  const float centre_m = rear_axle_to_centre_m(parameters);
  for (const ConflictZone& zone : path.zones) {
    const float to_entry_m = zone.entry_s_m - centre_m - s_m;
    const float to_exit_m = zone.exit_s_m - centre_m - s_m;
    if (to_exit_m <= 0.0F || to_entry_m > way_m) continue;
    if (-to_entry_m > to_exit_m) continue;  // most of it is behind us: on
    const float in_s = driving_time_s(max(to_entry_m, 0.0F), speed_mps);
    const float out_s = driving_time_s(min(to_exit_m, way_m), speed_mps);
    for (const Agent& agent : scene.agents) {
      occupancy::LaneReach reach;
      reach.measure(*scene.map, agent);
      const safety::ZoneOccupancy when = safety::zone_occupancy(scene, agent, reach, zone, 0.0F, parameters);
      if (when.claim == safety::Claim::kMayCome && when.from_s < out_s && when.until_s > in_s) return false;
    }
  }
  return true;
}

/// How to drive along the path: a stop beyond the zone we stand in, else braking.
void shape_braking(const Scene& scene, const EgoPath& path, float s_m, float speed_mps,
                   const Parameters& parameters, Candidate& candidate) {
  const float centre_m = rear_axle_to_centre_m(parameters);
  const float front_m = rear_axle_to_front_m(parameters);
  const Leader leader = find_leader(scene, path, path.frenet.s_m, parameters);
  const float free_m = leader.agent < 0 ? kNoDeadEndM : leader.gap_m - kGapM - (s_m - path.frenet.s_m);

  float braking = braking_into_lane(scene, path, speed_mps, parameters);
  if (leader.agent >= 0) {
    const float way_m = way_behind(leader.gap_m, leader.speed_mps, leader.acceleration_mps2, parameters);
    braking = harder(braking, speed_mps, way_m - (s_m - path.frenet.s_m), parameters);
  }
  const float end_m = dead_end_s_m(scene, path) - front_m - kGapM - s_m;
  if (end_m > 0.0F) braking = harder(braking, speed_mps, end_m, parameters);

  for (const ConflictZone& zone : path.zones) {
    const float to_entry_m = zone.entry_s_m - centre_m - s_m;
    const float to_exit_m = zone.exit_s_m - centre_m - s_m;
    const float stop_m = square(speed_mps) / (2.0F * braking) + kBuildUpS * speed_mps;
    const float clear_m = to_exit_m + kBeyondZoneM;
    const bool inside = to_entry_m < 0.0F && to_exit_m > 0.0F;
    if (inside && clear_m < free_m && clear_m < max(end_m, 0.0F) &&
        may_leave(scene, path, s_m, clear_m, speed_mps, parameters)) {
      candidate.intent = Intent::kStop;
      candidate.acceleration_mps2 = kLeavingMps2;
      candidate.target_s_m = s_m + max(clear_m, stop_m);
      return;
    }
    const float needed = needed_mps2(speed_mps, to_entry_m - kBeforeZoneM);
    if (to_entry_m > 0.0F && stop_m > to_entry_m - kBeforeZoneM && stop_m < to_exit_m &&
        needed < kForZoneMps2)
      braking = max(braking, needed);
  }
  candidate.intent = Intent::kAccelerate;
  candidate.acceleration_mps2 = -braking;
}

/// \return whether the motion is one the vehicle can follow
bool along_lane(const Scene& scene, const TrajectoryPoint& start, const Parameters& parameters,
                Trajectory& trajectory) {
  const int index = path_to_stop_on(scene, start, parameters);
  const EgoPath& path = scene.ego_paths[index];
  const Frenet frenet = project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 20.0F);
  ReferenceLine line;
  build_reference(*scene.map, path.path, frenet.s_m, start.speed_mps, parameters, line);
  const ReferenceCoordinates where = locate_on(line, position(start.rear_axle), frenet.s_m);
  Candidate candidate;
  candidate.path = static_cast<std::uint8_t>(index);
  shape_braking(scene, path, where.s_m, start.speed_mps, parameters, candidate);
  float length_m = lateral_length_m(line, start, where, parameters);
  const Plan none;
  for (int i = 0; i < kStretches; ++i) {
    shape_lateral(line, start, where, length_m, candidate);
    if (swings_wide(candidate)) break;
    roll_out(line, candidate, start, none, 0, parameters, trajectory);
    if (feasible(trajectory, parameters)) return true;
    length_m = kStretch * length_m;
  }
  candidate.steered = true;
  roll_out(line, candidate, start, none, 0, parameters, trajectory);
  return feasible(trajectory, parameters);
}

void along_plan(const Scene& scene, const TrajectoryPoint& start, const Plan& running, std::uint32_t start_ms,
                const Parameters& parameters, Trajectory& trajectory) {
  const std::int32_t elapsed_ms = static_cast<std::int32_t>(start_ms - running.start_ms);
  const TrajectoryPoint planned = sample(running, start_ms);
  const Point from = position(start.rear_axle) - position(planned.rear_axle);
  PathWalk walk(running.trajectory);
  float way_m = 0.0F;  // of the plan, already driven
  for (int i = 1; i <= elapsed_ms / kStepMs && i < kTrajectoryPoints; ++i) {
    way_m = way_m + distance(position(running.trajectory.points[i - 1].rear_axle),
                             position(running.trajectory.points[i].rear_axle));
  }
  way_m = way_m + distance(position(planned.rear_axle),
                           position(running.trajectory.points[elapsed_ms / kStepMs].rear_axle));

  const float braking = braking_straight_ahead(scene, start, parameters);
  LongitudinalState state{0.0F, start.speed_mps, start.acceleration_mps2};
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    TrajectoryPoint& point = trajectory.points[i];
    point = trajectory.points[i - 1];
    const float step_m = advance(-braking, parameters, state);
    if (step_m > 0.0F) {
      way_m = way_m + step_m;
      walk.place(way_m, point);
      // We may stand a little beside the plan: its path is driven in parallel.
      point.rear_axle.x_m = point.rear_axle.x_m + from.x_m;
      point.rear_axle.y_m = point.rear_axle.y_m + from.y_m;
    }
    point.speed_mps = state.speed_mps;
    point.acceleration_mps2 = state.acceleration_mps2;
  }
}

void as_steered(const Scene& scene, const TrajectoryPoint& start, const Parameters& parameters,
                Trajectory& trajectory) {
  const float braking = braking_straight_ahead(scene, start, parameters);
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    trajectory.points[i] = bicycle_step(trajectory.points[i - 1], -braking, 0.0F, kStepS);
  }
}

}  // namespace

void minimum_risk(const Scene& scene, const TrajectoryPoint& start, const Plan& running,
                  std::uint32_t start_ms, const Parameters& parameters, Trajectory& trajectory) {
  const bool has_lane = scene.map != nullptr && !scene.ego_paths.empty();
  if (has_lane && along_lane(scene, start, parameters, trajectory)) return;
  if (plan_covers(running, start_ms)) {
    along_plan(scene, start, running, start_ms, parameters, trajectory);
  } else if (!has_lane || !as_far_as_driven(trajectory)) {
    as_steered(scene, start, parameters, trajectory);
  }
}

}  // namespace s4tp
