#include "algo/planner/scoring.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp {
namespace {

constexpr float kCarefulSpeedShare = 0.6F;  // of the limit, while a source of ours is stale
constexpr float kChangeRoomM = 60.0F;  // a lane change left to do starts to press when its room is this short
constexpr float kGapReachM = 50.0F;    // beyond this nobody is in the way of a lane change
constexpr float kTypicalLaneM = 3.5F;
constexpr float kGapHeadwayS = 0.6F;   // between the two that a gap opens for
constexpr float kGapClosingS = 1.0F;   // more for each m/s the rear one is faster
constexpr float kGapShare = 0.25F;     // of lane_route, per metre of a gap missing
constexpr float kMissedRoute = 10.0F;  // times lane_route: driving past the last place to change lanes

/// The path beside `path` towards the route's lane, or null.
const EgoPath* path_towards_route(const Scene& scene, const EgoPath& path) {
  if (path.manoeuvre != Manoeuvre::kKeep || path.changes_needed == 0) return nullptr;
  const Manoeuvre wanted = path.changes_needed > 0 ? Manoeuvre::kLeft : Manoeuvre::kRight;
  for (const EgoPath& other : scene.ego_paths) {
    if (other.manoeuvre == wanted) return &other;
  }
  return nullptr;
}

/// How much the gaps to the vehicles of a lane fall short of what a change into it takes, at the horizon's
/// end [m].
float gap_shortage_m(const Scene& scene, const KinematicSet& keep_going, const EgoPath& path,
                     const TrajectoryPoint& end, const Parameters& parameters) {
  const Point own = position(ego_box(end.rear_axle, parameters).centre);
  const Frenet at = project(*scene.map, path.path, own, path.frenet.s_m, -1.0F);
  float shortage_m = 0.0F;
  for (int i = 0; i < keep_going.agents.size() && i < scene.agents.size(); ++i) {
    const Point there = position(keep_going.agents[i].steps[kHorizonSteps - 1]);
    if (distance(own, there) > kGapReachM) continue;
    const Frenet other = project(*scene.map, path.path, there, at.s_m, kGapReachM);
    if (abs(other.d_m) > 0.5F * kTypicalLaneM) continue;
    const Track& track = scene.agents[i].track;
    const float ahead_m = other.s_m - at.s_m;
    const float gap_m = abs(ahead_m) - 0.5F * (track.length_m + parameters.vehicle.length_m);
    const bool in_front = ahead_m > 0.0F;
    const float rear_mps = in_front ? end.speed_mps : track.speed_mps;
    const float closing_mps = max(0.0F, rear_mps - (in_front ? track.speed_mps : end.speed_mps));
    const float needed_m =
        parameters.comfort.standstill_gap_m + kGapHeadwayS * rear_mps + kGapClosingS * closing_mps;
    shortage_m = shortage_m + max(0.0F, needed_m - gap_m);
  }
  return shortage_m;
}

/// Price of the lane: how many changes are left, more pressing as the room for them shortens.
float route_cost(const EgoPath& path, float end_s_m, const Parameters& parameters) {
  const int changes = path.changes_needed < 0 ? -path.changes_needed : path.changes_needed;
  if (changes == 0) return 0.0F;
  const float room_m = path.route_end_s_m - end_s_m;
  if (room_m < 0.0F) return kMissedRoute * parameters.scoring.lane_route * static_cast<float>(changes);
  const float pressing = 1.0F + kChangeRoomM * static_cast<float>(changes) / (room_m + 10.0F);
  return parameters.scoring.lane_route * static_cast<float>(changes) * pressing;
}

}  // namespace

CostBreakdown score_motion(const Scene& scene, const KinematicSet& keep_going, int path_index,
                           const Trajectory& trajectory, bool keeps_plan, bool careful,
                           const Parameters& parameters) {
  const EgoPath& path = scene.ego_paths[path_index];
  const TrajectoryPoint& start = trajectory.points[0];
  const float start_s_m =
      project(*scene.map, path.path, position(start.rear_axle), path.frenet.s_m, 15.0F).s_m;

  float s_m = start_s_m;
  float speed_sum = 0.0F;
  float jerk_sum = 0.0F;
  float lateral_sum = 0.0F;
  float offset_sum = 0.0F;
  int offset_count = 0;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& before = trajectory.points[i - 1];
    const TrajectoryPoint& point = trajectory.points[i];
    s_m = s_m + kStepS * 0.5F * (before.speed_mps + point.speed_mps);
    const float jerk = (point.acceleration_mps2 - before.acceleration_mps2) / kStepS;
    jerk_sum = jerk_sum + jerk * jerk;
    const float lateral = point.speed_mps * point.speed_mps * point.curvature_1pm;
    lateral_sum = lateral_sum + lateral * lateral;
    if (i % 5 != 0) continue;  // lane data change slowly: every half second is enough
    const Frenet frenet = project(*scene.map, path.path, position(point.rear_axle), s_m, 5.0F);
    const PathPoint centre = path_point(*scene.map, path.path, frenet.s_m);
    float wanted_mps = centre.speed_limit_mps;
    const float bend = abs(centre.curvature_1pm);
    if (bend * wanted_mps * wanted_mps > parameters.comfort.lateral_mps2) {
      wanted_mps = sqrt(parameters.comfort.lateral_mps2 / bend);
    }
    if (careful) wanted_mps = min(wanted_mps, kCarefulSpeedShare * centre.speed_limit_mps);
    const float excess_mps = point.speed_mps - wanted_mps;
    // Too fast is worse than too slow by as much: the limit is a limit.
    speed_sum = speed_sum + (excess_mps > 0.0F ? 4.0F * excess_mps : -excess_mps);
    offset_sum = offset_sum + square(frenet.d_m);
    ++offset_count;
  }
  const float steps = static_cast<float>(kHorizonSteps);
  const float samples = static_cast<float>(offset_count);

  CostBreakdown cost;
  cost.progress = -parameters.scoring.progress * (s_m - start_s_m);
  cost.speed = parameters.scoring.speed * (speed_sum / samples) * 3.0F;
  cost.jerk = parameters.scoring.jerk * (jerk_sum / steps);
  cost.lateral = parameters.scoring.lateral_acceleration * (lateral_sum / steps);
  cost.lane = parameters.scoring.lane_offset * (offset_sum / samples) + route_cost(path, s_m, parameters);
  if (const EgoPath* beside = path_towards_route(scene, path); beside != nullptr) {
    cost.lane = cost.lane +
                kGapShare * parameters.scoring.lane_route *
                    gap_shortage_m(scene, keep_going, *beside, trajectory.points[kHorizonSteps], parameters);
  }
  if (path.manoeuvre != Manoeuvre::kKeep && !keeps_plan)
    cost.lane = cost.lane + parameters.scoring.lane_change;
  return cost;
}

}  // namespace s4tp
