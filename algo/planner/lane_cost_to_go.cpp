#include "algo/planner/lane_cost_to_go.hpp"

#include "algo/core/inline.hpp"
#include "algo/occupancy/pace.hpp"
#include "algo/safety/change_gaps.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::planner {
namespace {

constexpr float kFarM = 150.0F;        // the map's horizon
constexpr float kFastestMps = 100.0F;  // wanted where nobody is ahead
constexpr float kCrawlMps = 3.0F;      // who stands or crawls will not do so all the way
constexpr float kAlongCos = 0.7F;      // 45 degrees: crossing and oncoming traffic is no matter of lanes
constexpr float kInsideM = 1.0F;       // aimed at within a gap that has room for it

// Work (WorkMeter's units).
constexpr int kLaneWork = 20;   // of a lane, and of each vehicle that counts there: ...
constexpr int kGapWork = 8;     // ... to find the gaps, ...
constexpr int kAskingWork = 4;  // ... to ask how long it delays us and how to close up on it, ...
constexpr int kAskingLaneWork = 6;
constexpr int kOtherWork = 2;  // ... to see that it does not count

/// Where our front is at the end of the lane, or of the part of it where lane changes due can be made.
float lane_end_s_m(const scene::Scene& scene, const scene::EgoPath& path, const Parameters& parameters) {
  return min(path.route_end_s_m, trajectory::dead_end_s_m(scene, path)) -
         trajectory::rear_axle_to_front_m(parameters);
}

}  // namespace

int LaneCostToGo::look(const scene::Scene& scene, const satp::KinematicSet& constant_velocity, float lead_s,
                       const Parameters& parameters) {
  lanes_.clear();
  parameters_ = &parameters;
  centre_m_ = trajectory::rear_axle_to_centre_m(parameters);
  if (scene.ego_paths.empty()) return 0;
  int work = 0;
  const scene::EgoPath& own = scene.ego_paths[0];
  weight_ = 1.0F;
  float way_m = 0.0F;
  for (const float by_s_m : own.change_by_s_m) {
    way_m = way_m + kChangeRoomM;
    weight_ = min(weight_, max(0.0F, (by_s_m - own.frenet.s_m - way_m) / kChangeRoomM));
  }
  way_m_ = clamp(own.goal_s_m - own.frenet.s_m, 0.0F, kFarM);
  const int count = constant_velocity.agents.size() < scene.agents.size() ? constant_velocity.agents.size()
                                                                          : scene.agents.size();
  for (const scene::EgoPath& path : scene.ego_paths) {
    const scene::PathPoint here = scene::path_point(*scene.map, path.path, path.frenet.s_m);
    Lane lane;
    lane.target_s_m = path.frenet.s_m + way_m_;
    lane.limit_mps = max(here.speed_limit_mps, kCrawlMps);
    lane.room_s_m = lane_end_s_m(scene, path, parameters) - trajectory::change_room_m(scene, path);
    const float half_lane_m = 0.5F * here.width_m;
    const float to_route_m = static_cast<float>(path.changes_needed) * here.width_m;
    for (int i = 0; i < count; ++i) {
      const Track& track = scene.agents[i].track;
      const Pose& then = constant_velocity.agents[i].steps[kHorizonSteps - 1];
      const scene::Frenet frenet =
          scene::project(*scene.map, path.path, position(then), path.frenet.s_m, -1.0F, work);
      const float along = cos(wrap_angle(then.heading_rad - frenet.heading_rad));
      if (along < kAlongCos) continue;
      const bool in_lane = abs(frenet.d_m) <= half_lane_m;
      const bool to_return = path.changes_needed != 0 && abs(frenet.d_m - to_route_m) <= half_lane_m;
      if (!in_lane && !to_return) continue;
      (void)lane.seen.push({frenet.s_m, track.length_m, along * track.speed_mps, in_lane});
      lane.returns = lane.returns || !in_lane;
    }
    work += kLaneWork + kOtherWork * count + kGapWork * lane.seen.size();
    put_in_order(lane.seen);
    (void)lanes_.push(lane);
  }
  find_gaps(scene, lead_s);
  return work;
}

int LaneCostToGo::asking_work() const {
  int work = 0;
  for (const Lane& lane : lanes_) work += kAskingLaneWork + kAskingWork * lane.seen.size();
  return work;
}

void LaneCostToGo::find_gaps(const scene::Scene& scene, float lead_s) {
  const scene::EgoPath& own = scene.ego_paths[0];
  our_s_m_ = own.frenet.s_m + lead_s * scene.ego.speed_mps;
  GapSeeker us;
  us.speed_mps = scene.ego.speed_mps;
  us.limit_mps = lanes_[0].limit_mps;
  for (const LaneVehicle& other : lanes_[0].seen) {
    const float touch_s_m = other.s_m - other.speed_mps * kHorizonS - 0.5F * other.length_m -
                            trajectory::rear_axle_to_front_m(*parameters_);
    if (!other.in_lane || touch_s_m < our_s_m_) continue;
    if (us.has_leader && touch_s_m > us.leader_s_m) continue;
    us.has_leader = true;
    us.leader_s_m = touch_s_m;
    us.leader_mps = other.speed_mps;
  }
  us.change_due = own.changes_needed != 0;
  const float leader_s_m = us.leader_s_m;
  const float end_s_m = lane_end_s_m(scene, own, *parameters_);
  for (int i = 1; i < lanes_.size(); ++i) {
    const float shift_m = scene.ego_paths[i].frenet.s_m - own.frenet.s_m;
    us.s_m = our_s_m_ + shift_m;
    us.end_s_m = end_s_m + shift_m;
    us.leader_s_m = leader_s_m + shift_m;
    lanes_[i].gap = find_lane_gap(lanes_[i].seen, us, *parameters_);
  }
}

float LaneCostToGo::standing_gap_m(const LaneVehicle& other) const {
  return 0.5F * (parameters_->vehicle.length_m + other.length_m) + parameters_->comfort.standstill_gap_m;
}

float LaneCostToGo::behind_s(const LaneVehicle& other, float to_s_m) const {
  const float speed = max(other.speed_mps, kCrawlMps);
  const float gap_m = standing_gap_m(other) + parameters_->comfort.headway_s * speed;
  return (to_s_m + centre_m_ + gap_m - other.s_m) / speed;
}

float LaneCostToGo::arrival_s(const Lane& lane, float s_m, float speed_mps) const {
  const occupancy::Pace alone = {min(speed_mps, lane.limit_mps), parameters_->comfort.acceleration_mps2,
                                 lane.limit_mps};
  float longest_s = occupancy::time_to_cover_s(alone, lane.target_s_m - s_m);
  for (const LaneVehicle& other : lane.seen) {
    if (other.in_lane && other.s_m >= s_m + centre_m_)
      longest_s = max(longest_s, behind_s(other, lane.target_s_m));
  }
  return longest_s;
}

float LaneCostToGo::delay_s(int path, float s_m, float speed_mps) const {
  const Lane& lane = lanes_[path];
  const float ideal_s = way_m_ / lane.limit_mps;
  float longest_s = arrival_s(lane, s_m, speed_mps);
  if (lane.returns) longest_s = max(longest_s, return_s(lane, s_m, speed_mps));
  return weight_ * max(0.0F, kHorizonS + longest_s - ideal_s);
}

bool LaneCostToGo::can_be_at(const Lane& lane, float place_s_m, float time_s, float s_m) const {
  if (time_s >= occupancy::kNeverS || place_s_m > lane.room_s_m) return false;
  for (const LaneVehicle& other : lane.seen) {
    if (!other.in_lane || other.s_m < s_m + centre_m_) continue;
    if (place_s_m + centre_m_ + standing_gap_m(other) > other.s_m + other.speed_mps * time_s) return false;
  }
  return true;
}

bool LaneCostToGo::can_join(const Lane& lane, const LaneVehicle* front, const LaneVehicle* rear, float s_m,
                            float speed_mps) const {
  if (front == nullptr) {
    // Ahead of all of them we need not be as slow as they are, but as fast as we can be by then.
    const float gained = 2.0F * parameters_->comfort.acceleration_mps2 * max(0.0F, lane.room_s_m - s_m);
    const float own_mps = min(lane.limit_mps, sqrt(square(speed_mps) + gained));
    const float ahead_m = 0.5F * rear->length_m + parameters_->vehicle.rear_overhang_m +
                          safety::change_gap_to_follower_m(own_mps, rear->speed_mps, *parameters_);
    const float way_m = max(0.0F, rear->s_m + ahead_m - s_m);
    const float time_s = way_m / max(own_mps - rear->speed_mps, 0.01F);
    return can_be_at(lane, s_m + own_mps * time_s, time_s, s_m);
  }
  const LaneGap gap = gap_between(front, rear, lane.limit_mps, *parameters_);
  if (!gap.found) return false;
  const float time_s = time_to_meet_s(gap, 0.0F, s_m, speed_mps, lane.limit_mps, *parameters_);
  return can_be_at(lane, place_in_gap_m(gap, 0.0F, s_m, speed_mps, time_s), time_s, s_m);
}

float LaneCostToGo::return_s(const Lane& lane, float s_m, float speed_mps) const {
  const LaneVehicle* front = nullptr;
  for (int i = 0; i <= lane.seen.size(); ++i) {
    const LaneVehicle* rear = i < lane.seen.size() ? &lane.seen[i] : nullptr;
    if (rear != nullptr && rear->in_lane) continue;
    if (can_join(lane, front, rear, s_m, speed_mps))
      return front != nullptr ? behind_s(*front, lane.target_s_m) : 0.0F;
    if (rear != nullptr) front = rear;
  }
  const occupancy::Pace from_rest = {0.0F, parameters_->comfort.acceleration_mps2, lane.limit_mps};
  return max(0.0F, behind_s(*front, lane.room_s_m)) +
         occupancy::time_to_cover_s(from_rest, max(0.0F, lane.target_s_m - lane.room_s_m));
}

float LaneCostToGo::closing_up_mps(int path, float start_s_m, float s_m, float time_s) const {
  float square_mps = square(kFastestMps);
  for (const LaneVehicle& other : lanes_[path].seen) {
    if (!other.in_lane || other.s_m - kHorizonS * other.speed_mps < start_s_m + centre_m_) continue;
    const float place_s_m =
        other.s_m - (kHorizonS - time_s) * other.speed_mps - standing_gap_m(other) - centre_m_;
    const float room_m = place_s_m - s_m;
    square_mps = min(square_mps, square(max(other.speed_mps, 0.0F)) +
                                     2.0F * parameters_->comfort.braking_mps2 * max(room_m, 0.0F));
  }
  return sqrt(square_mps);
}

float LaneCostToGo::time_to_gap_s(int path, float s_m, float speed_mps) const {
  const Lane& lane = lanes_[path];
  if (!lane.gap.found) return 0.0F;
  return time_to_meet_s(lane.gap, 0.0F, s_m, speed_mps, lane.limit_mps, *parameters_);
}

trajectory::MergeTarget LaneCostToGo::merge_target(const scene::Scene& scene, int path) const {
  const LaneGap& gap = lanes_[path].gap;
  trajectory::MergeTarget aim;
  if (!gap.found) return aim;
  const float shift_m = scene.ego_paths[path].frenet.s_m - scene.ego_paths[0].frenet.s_m;
  const float back_m = gap.speed_mps * kHorizonS + shift_m;
  aim.path = static_cast<std::uint8_t>(path);
  aim.speed_mps = gap.speed_mps;
  aim.s_m = our_s_m_;
  const bool bounded = gap.bounded_behind && gap.bounded_ahead;
  const float inside_m = bounded ? min(kInsideM, 0.5F * (gap.front_s_m - gap.rear_s_m)) : kInsideM;
  if (gap.bounded_behind) aim.s_m = max(aim.s_m, gap.rear_s_m + inside_m - back_m);
  if (gap.bounded_ahead) aim.s_m = min(aim.s_m, gap.front_s_m - inside_m - back_m);
  return aim;
}

}  // namespace s4tp::planner
