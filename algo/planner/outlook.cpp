#include "algo/planner/outlook.hpp"

#include "algo/core/inline.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp {
namespace {

constexpr float kFarM = 150.0F;  // the map's horizon
constexpr float kHorizonS = static_cast<float>(kHorizonSteps) * kStepS;
constexpr float kCrawlMps = 3.0F;     // who stands or crawls will not do so all the way
constexpr float kRoomM = 60.0F;       // for each lane change left to do; with no more, nothing else counts
constexpr float kReturnS = 2.0F;      // of driving: room a lane change back takes
constexpr float kGapReachM = 50.0F;   // beyond this nobody is in the way of a lane change
constexpr float kGapHeadwayS = 0.6F;  // between the two that a gap opens for
constexpr float kGapClosingS = 1.0F;  // more for each m/s the rear one is faster

/// Time over `way_m` from `speed_mps`, accelerating to the limit.
float driving_time_s(float way_m, float speed_mps, float limit_mps, float acceleration_mps2) {
  if (way_m <= 0.0F) return 0.0F;
  if (speed_mps >= limit_mps) return way_m / limit_mps;
  const float build_up_m = (square(limit_mps) - square(speed_mps)) / (2.0F * acceleration_mps2);
  if (way_m >= build_up_m) {
    return (limit_mps - speed_mps) / acceleration_mps2 + (way_m - build_up_m) / limit_mps;
  }
  return (sqrt(square(speed_mps) + 2.0F * acceleration_mps2 * way_m) - speed_mps) / acceleration_mps2;
}

}  // namespace

void Outlook::look(const Scene& scene, const KinematicSet& keep_going, const Parameters& parameters) {
  lanes_.clear();
  length_m_ = parameters.vehicle.length_m;
  centre_m_ = rear_axle_to_centre_m(parameters);
  acceleration_mps2_ = parameters.comfort.acceleration_mps2;
  standstill_gap_m_ = parameters.comfort.standstill_gap_m;
  headway_s_ = parameters.comfort.headway_s;
  if (scene.ego_paths.empty()) return;
  const EgoPath& own = scene.ego_paths[0];
  const int changes = own.changes_needed < 0 ? -own.changes_needed : own.changes_needed;
  const float spare_m = own.route_end_s_m - own.frenet.s_m - kRoomM * static_cast<float>(changes);
  weight_ = changes == 0 ? 1.0F : clamp(spare_m / kRoomM, 0.0F, 1.0F);
  way_m_ = clamp(scene.ego_paths[0].goal_s_m - scene.ego_paths[0].frenet.s_m, 0.0F, kFarM);
  const int count =
      keep_going.agents.size() < scene.agents.size() ? keep_going.agents.size() : scene.agents.size();
  for (const EgoPath& path : scene.ego_paths) {
    const PathPoint here = path_point(*scene.map, path.path, path.frenet.s_m);
    Lane lane;
    lane.target_s_m = path.frenet.s_m + way_m_;
    lane.limit_mps = max(here.speed_limit_mps, kCrawlMps);
    lane.return_s_m = path.route_end_s_m - kReturnS * lane.limit_mps;
    const float half_lane_m = 0.5F * here.width_m;
    const float to_route_m = static_cast<float>(path.changes_needed) * here.width_m;
    for (int i = 0; i < count; ++i) {
      const Track& track = scene.agents[i].track;
      const Pose& then = keep_going.agents[i].steps[kHorizonSteps - 1];
      const Frenet frenet = project(*scene.map, path.path, position(then), path.frenet.s_m, -1.0F);
      const float along = cos(wrap_angle(then.heading_rad - frenet.heading_rad));
      if (along < 0.7F) continue;  // crossing and oncoming traffic is no matter of lanes
      const bool in_lane = abs(frenet.d_m) <= half_lane_m;
      const bool to_return = to_route_m > 0.0F ? frenet.d_m > 0.0F && frenet.d_m < to_route_m + half_lane_m
                                               : frenet.d_m < 0.0F && frenet.d_m > to_route_m - half_lane_m;
      if (!in_lane && (path.changes_needed == 0 || !to_return)) continue;
      (void)lane.seen.push({frenet.s_m, track.length_m, along * track.speed_mps, in_lane});
    }
    (void)lanes_.push(lane);
  }
}

float Outlook::delay_s(int path, float s_m, float speed_mps) const {
  const Lane& lane = lanes_[path];
  const float ideal_s = way_m_ / lane.limit_mps;
  const float free_s = driving_time_s(lane.target_s_m - s_m, speed_mps, lane.limit_mps, acceleration_mps2_);
  const float back_s = driving_time_s(lane.return_s_m - s_m, speed_mps, lane.limit_mps, acceleration_mps2_);
  const float centre_s_m = s_m + centre_m_;
  float longest_s = free_s;
  for (const Seen& other : lane.seen) {
    if (other.s_m < centre_s_m) continue;
    const float speed = max(other.speed_mps, kCrawlMps);
    const float lengths_m = 0.5F * (length_m_ + other.length_m) + standstill_gap_m_;
    if (!other.in_lane) {
      const float ahead_m = max(lane.return_s_m, s_m) + centre_m_ - (other.s_m + speed * back_s);
      if (ahead_m > lengths_m) continue;  // passed by then
    }
    // Behind him we are at the target when he is a gap beyond it.
    const float gap_m = lengths_m + headway_s_ * speed;
    longest_s = max(longest_s, (lane.target_s_m + centre_m_ + gap_m - other.s_m) / speed);
  }
  return weight_ * max(0.0F, kHorizonS + longest_s - ideal_s);
}

float Outlook::gap_shortage_m(int path, float s_m, float speed_mps) const {
  const float centre_s_m = s_m + centre_m_;
  float shortage_m = 0.0F;
  for (const Seen& other : lanes_[path].seen) {
    if (!other.in_lane) continue;
    const float ahead_m = other.s_m - centre_s_m;
    if (abs(ahead_m) > kGapReachM) continue;
    const float gap_m = abs(ahead_m) - 0.5F * (other.length_m + length_m_);
    const bool in_front = ahead_m > 0.0F;
    const float rear_mps = in_front ? speed_mps : other.speed_mps;
    const float closing_mps = max(0.0F, rear_mps - (in_front ? other.speed_mps : speed_mps));
    const float needed_m = standstill_gap_m_ + kGapHeadwayS * rear_mps + kGapClosingS * closing_mps;
    shortage_m = shortage_m + max(0.0F, needed_m - gap_m);
  }
  return shortage_m;
}

}  // namespace s4tp
