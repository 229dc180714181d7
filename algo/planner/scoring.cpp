#include "algo/planner/scoring.hpp"

#include "algo/core/inline.hpp"
#include "algo/core/standing.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::planner {
namespace {

constexpr int kMotionWork = 40;             // WorkMeter's units
constexpr float kCarefulSpeedShare = 0.6F;  // of the limit, while a source of ours is stale
constexpr float kGapShare = 0.5F;  // of what the lane beside gains, for each second until its gap is met
constexpr float kLongestS = 8.0F;
constexpr float kPressM = 10.0F;       // with less room left than this, changes press no more
constexpr float kSeekM = 5.0F;         // each way of where a plan is along its path
constexpr float kTooFastMps = 4.0F;    // as bad at least as being so much too slow, for each m/s too fast
constexpr float kInLaneShare = 0.4F;   // of its width from a lane's centre, a change counts as made
constexpr float kMissedRoute = 80.0F;  // times lane_route: driving past the last place to change lanes
constexpr float kLateShare = 4.0F;     // of what progress is worth, each metre past it costs

/// Price of being in the right lane so late: all of a missed route where that takes another change's way, and beyond
/// that more than the way driven gains. \param changes  left to make
float late_cost(float late_by_m, float changes, const Parameters& parameters) {
  return kMissedRoute * parameters.scoring.lane_route * min(changes, late_by_m / scene::kChangeWayM) +
         kLateShare * parameters.scoring.progress * late_by_m;
}

/// From where the changes that `path` needs are made, by whoever drives there as far as `end_s_m`: no lane beside, no
/// choice yet, and nothing missed.
float changes_from_s_m(const scene::EgoPath& path, float end_s_m) {
  return path.frenet.s_m < path.change_from_s_m ? path.change_from_s_m : end_s_m;
}

/// What whoever is in the lane of `path` at the horizon's end with no room left for the changes it needs pays, as one
/// does who changes late: else it stood for ever where a change would be. In the lane we are in we may have to wait for
/// one, and then change from rest; on the way to another one, or to where there is one, what comes next is one or the other.
/// \param unmade  share of the change into that lane that comes first
float no_room_cost(const scene::Scene& scene, int path_index, float end_s_m, float end_mps, float unmade,
                   const Parameters& parameters) {
  const scene::EgoPath& path = scene.ego_paths[path_index];
  const float from_s_m = changes_from_s_m(path, end_s_m);
  const float front_s_m = from_s_m + trajectory::rear_axle_to_front_m(parameters);
  const bool waits = path_index == 0 && path.frenet.s_m >= path.change_from_s_m;
  const float stop_m = occupancy::stopping_way_m(end_mps, parameters.comfort.braking_mps2);
  float cost = 0.0F;
  float count = 0.0F;
  for (const float by_s_m : path.change_by_s_m) {
    count = count + 1.0F;
    const float changes_m = scene::kChangeWayM * (count + unmade);
    const float needed_m = waits ? changes_m + stop_m : max(changes_m, stop_m);
    cost = max(cost, late_cost(max(0.0F, needed_m - (by_s_m - front_s_m)), count, parameters));
  }
  return cost;
}

/// What driving on in the lane of `path` costs from the horizon's end on: time lost there, and lane changes left, more
/// pressing as the room for them shortens.
float driving_on_cost(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path_index,
                      float end_s_m, float end_mps, const Parameters& parameters) {
  const scene::EgoPath& path = scene.ego_paths[path_index];
  const float from_s_m = changes_from_s_m(path, end_s_m);
  float pressing = 0.0F;
  float way_m = 0.0F;  // that the changes so far take
  for (const float by_s_m : path.change_by_s_m) {
    way_m = way_m + kChangeRoomM;
    pressing = pressing + 1.0F + way_m / (max(by_s_m - from_s_m, 0.0F) + kPressM);
  }
  return parameters.scoring.delay * cost_to_go.delay_s(path_index, end_s_m, end_mps) +
         parameters.scoring.lane_route * pressing;
}

/// What being in the lane of `path` at the horizon's end costs.
float lane_cost(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path, float s_m,
                float speed_mps, const Parameters& parameters) {
  return driving_on_cost(scene, cost_to_go, path, s_m, speed_mps, parameters) +
         no_room_cost(scene, path, s_m, speed_mps, 0.0F, parameters);
}

/// The lane beside that we had rather be in, or -1. \param gain  receives what it saves, 0: nothing
int better_lane(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path, float s_m,
                float speed_mps, float cost_here, const Parameters& parameters, float& gain) {
  gain = 0.0F;
  int best = -1;
  for (int i = 0; i < scene.ego_paths.size(); ++i) {
    if (i == path) continue;
    const float there_s_m = s_m + scene.ego_paths[i].frenet.s_m - scene.ego_paths[path].frenet.s_m;
    const float cost = lane_cost(scene, cost_to_go, i, there_s_m, speed_mps, parameters);
    if (cost_here - cost <= gain) continue;
    gain = cost_here - cost;
    best = i;
  }
  return best;
}

/// Price of the time until we are in the gap of the lane beside that we had rather be in, if there is one.
float gap_cost(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path, float s_m,
               float speed_mps, float cost_here, const Parameters& parameters) {
  float gain = 0.0F;
  const int lane = better_lane(scene, cost_to_go, path, s_m, speed_mps, cost_here, parameters, gain);
  if (lane < 0) return 0.0F;
  const float there_s_m = s_m + scene.ego_paths[lane].frenet.s_m - scene.ego_paths[path].frenet.s_m;
  return kGapShare * min(gain, parameters.scoring.lane_route) *
         min(cost_to_go.time_to_gap_s(lane, there_s_m, speed_mps), kLongestS);
}

/// What the lane costs a motion that ends `beside_m` from the centre of `path`: as much of the change as is not made,
/// one is still in ours. Whether it will be made in time is LastPlace's to say.
float lane_cost_between(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path, float s_m,
                        float beside_m, float width_m, float speed_mps, const Parameters& parameters) {
  const float there = driving_on_cost(scene, cost_to_go, path, s_m, speed_mps, parameters);
  const float unmade = path == 0 ? 0.0F : min(beside_m / width_m, 1.0F);
  // Whoever moves makes it on the way to the next one.
  const float first = speed_mps < kStandingMps ? unmade : 0.0F;
  const float cost = there + no_room_cost(scene, path, s_m, speed_mps, first, parameters);
  const float in_ours = (unmade - kInLaneShare) / (1.0F - kInLaneShare);
  if (in_ours <= 0.0F) return cost;
  const float own_s_m = s_m + scene.ego_paths[0].frenet.s_m - scene.ego_paths[path].frenet.s_m;
  return cost + in_ours * (driving_on_cost(scene, cost_to_go, 0, own_s_m, speed_mps, parameters) - there);
}

/// The last place at which a lane change that is due may still be between the lanes: where ours ends. Followed
/// along a motion.
struct LastPlace {
  float s_m;        ///< of our rear axle, along the path changed to
  float in_lane_m;  ///< so near to that path's centre the change counts as made
  float at_s_m;     ///< of the motion so far
  float at_d_m;
  float left_m = 0.0F;  ///< to that place sideways, at the last place or the motion's end
  bool passed = false;

  void go_on(float to_s_m, float to_d_m) {
    const bool passes = !passed && to_s_m >= s_m;
    const float part = passes ? (s_m - at_s_m) / max(to_s_m - at_s_m, 1e-3F) : 1.0F;
    if (!passed) left_m = max(0.0F, abs(lerp(at_d_m, to_d_m, part)) - in_lane_m);
    passed = passed || passes;
    at_s_m = to_s_m;
    at_d_m = to_d_m;
  }
  /// Way that what is left to be changed at the last place takes, and more the further the motion goes past it; before
  /// that, how far beyond it the change would be made. 0: in time.
  [[nodiscard]] float late_by_m(float width_m) const {
    const float way_m = scene::kChangeWayM * left_m / width_m;
    const float past_m = at_s_m - s_m;
    return passed ? way_m * (1.0F + past_m / scene::kChangeWayM) : max(0.0F, past_m + way_m);
  }
};

/// Way that gaining speed costs from `s_m` on, beside one who drives at the limits of the path: in each lane as much as is
/// not driven there in the time it takes. Before a faster lane, too: else who stands before it had nothing to lose,
/// and who drives into it slowly all. \param share  of the limits that is wanted  \param most_mps  wanted at most
float way_lost_m(const scene::Scene& scene, const scene::LanePath& path, float s_m, float speed_mps,
                 float share, float most_mps, float gain_mps2) {
  float lost_m = 0.0F;
  for (int i = 0; i < path.lanes.size(); ++i) {
    const bool last = i + 1 >= path.lanes.size();
    const float left_m = last ? trajectory::kNoDeadEndM : path.lanes[i + 1].start_s_m - s_m;
    if (left_m <= 0.0F) continue;
    s_m = s_m + left_m;
    const float wanted_mps = min(most_mps, share * scene.map->lanes[path.lanes[i].lane].speed_limit_mps);
    speed_mps = min(speed_mps, wanted_mps);
    const float gained_mps = min(wanted_mps, sqrt(square(speed_mps) + 2.0F * gain_mps2 * left_m));
    const float mean_mps = 0.5F * (speed_mps + gained_mps);
    lost_m = lost_m + (wanted_mps - mean_mps) * (gained_mps - speed_mps) / gain_mps2;
    speed_mps = gained_mps;
  }
  return lost_m;
}

/// The path that leads furthest along the route, `path_index` unless another one does by a lane change's way: as fast as its
/// way is we want to be. A lane that we are to leave may lead to a slow road, where standing costs little.
const scene::EgoPath& way_ahead(const scene::Scene& scene, int path_index) {
  const auto leads_m = [](const scene::EgoPath& path) { return path.route_end_s_m - path.frenet.s_m; };
  const scene::EgoPath* best = &scene.ego_paths[path_index];
  float most_m = leads_m(*best) + scene::kChangeWayM;
  for (const scene::EgoPath& path : scene.ego_paths) {
    if (leads_m(path) <= most_m) continue;
    most_m = leads_m(path);
    best = &path;
  }
  return *best;
}

}  // namespace

trajectory::MergeTarget merge_target_of(const scene::Scene& scene, const LaneCostToGo& cost_to_go,
                                        const Parameters& parameters) {
  if (scene.ego_paths.empty()) return {};
  const float speed_mps = scene.ego.speed_mps;
  const float s_m = scene.ego_paths[0].frenet.s_m + kHorizonS * speed_mps;
  const float here = lane_cost(scene, cost_to_go, 0, s_m, speed_mps, parameters);
  float gain = 0.0F;
  const int lane = better_lane(scene, cost_to_go, 0, s_m, speed_mps, here, parameters, gain);
  return lane < 0 ? trajectory::MergeTarget{} : cost_to_go.merge_target(scene, lane);
}

CostBreakdown score_motion(const scene::Scene& scene, const LaneCostToGo& cost_to_go, int path_index,
                           const trajectory::ReferenceLine& line, float start_s_m,
                           const Trajectory& trajectory, bool leaves, bool careful,
                           const Parameters& parameters, int& work) {
  work += kMotionWork + cost_to_go.asking_work();
  const scene::EgoPath& path = scene.ego_paths[path_index];
  float s_m = start_s_m;
  float speed_sum = 0.0F;
  float jerk_sum = 0.0F;
  float lateral_sum = 0.0F;
  float offset_sum = 0.0F;
  float behind_mps = 0.0F;  // wanted at the last place looked at for whoever is ahead there
  int offset_count = 0;
  const float limit_share = careful ? kCarefulSpeedShare : 1.0F;
  const scene::EgoPath& own = scene.ego_paths[0];
  const float width_m = scene::path_point(*scene.map, path.path, path.frenet.s_m).width_m;
  LastPlace last{
      own.route_end_s_m + path.frenet.s_m - own.frenet.s_m - trajectory::rear_axle_to_centre_m(parameters),
      kInLaneShare * width_m, start_s_m, path.frenet.d_m};
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    const TrajectoryPoint& before = trajectory.points[i - 1];
    const TrajectoryPoint& point = trajectory.points[i];
    s_m = s_m + kStepS * 0.5F * (before.speed_mps + point.speed_mps);
    const float jerk = (point.acceleration_mps2 - before.acceleration_mps2) / kStepS;
    jerk_sum = jerk_sum + jerk * jerk;
    const float lateral = point.speed_mps * point.speed_mps * point.curvature_1pm;
    lateral_sum = lateral_sum + lateral * lateral;
    if (i % 5 != 0) continue;  // lane data change slowly: every half second is enough
    scene::PathPoint centre;
    const scene::Frenet frenet =
        scene::project(*scene.map, path.path, position(point.rear_axle), s_m, kSeekM, centre, work);
    behind_mps = cost_to_go.closing_up_mps(path_index, start_s_m, s_m, static_cast<float>(i) * kStepS);
    // What may be driven there so that bends and limits further on are met in time, too.
    const float may_mps = min(limit_share * centre.speed_limit_mps, trajectory::speed_cap_at(line, s_m));
    const float wanted_mps = min(may_mps, behind_mps);
    const float excess_mps = point.speed_mps - wanted_mps;
    // Too fast is worse than too slow by as much, and the more of it the harder it is to lose before what it is too fast for.
    speed_sum = speed_sum + (excess_mps > 0.0F ? (kTooFastMps + excess_mps) * excess_mps : -excess_mps);
    offset_sum = offset_sum + square(frenet.d_m);
    last.go_on(s_m, frenet.d_m);
    ++offset_count;
  }
  const float steps = static_cast<float>(kHorizonSteps);
  const float samples = static_cast<float>(offset_count);

  CostBreakdown cost;
  cost.progress = -parameters.scoring.progress * (s_m - start_s_m);
  cost.speed = parameters.scoring.speed * (speed_sum / samples) * kHorizonS;
  cost.jerk = parameters.scoring.jerk * (jerk_sum / steps);
  cost.lateral = parameters.scoring.lateral_acceleration * (lateral_sum / steps);
  const float end_mps = trajectory.points[kHorizonSteps].speed_mps;
  // Way lost from the horizon's end on until we are as fast as wanted. A bend there is left out: it ends.
  const scene::EgoPath& ahead = way_ahead(scene, path_index);
  cost.progress =
      cost.progress + parameters.scoring.progress *
                          way_lost_m(scene, ahead.path, s_m + ahead.frenet.s_m - path.frenet.s_m, end_mps,
                                     limit_share, behind_mps, parameters.comfort.acceleration_mps2);
  const float lane =
      lane_cost_between(scene, cost_to_go, path_index, s_m, abs(last.at_d_m), width_m, end_mps, parameters);
  cost.lane = parameters.scoring.lane_offset * (offset_sum / samples) + lane;
  if (path.manoeuvre == scene::Manoeuvre::kKeep)
    cost.lane = cost.lane + gap_cost(scene, cost_to_go, path_index, s_m, end_mps, lane, parameters);
  if (path.manoeuvre != scene::Manoeuvre::kKeep && own.changes_needed != 0)
    cost.lane = cost.lane + late_cost(last.late_by_m(width_m), 1.0F, parameters);
  if (leaves) cost.lane = cost.lane + parameters.scoring.lane_change;
  return cost;
}

}  // namespace s4tp::planner
