#include "algo/satp/ego_motion.hpp"

#include "algo/core/inline.hpp"
#include "algo/satp/car_following.hpp"

namespace s4tp::satp {
namespace {

constexpr float kSideMarginM = 0.3F;     // between boxes side by side
constexpr float kAlongCos = 0.5F;        // 60 degrees
constexpr float kFarM = 90.0F;           // who is further away reacts to nothing we do within the horizon
constexpr float kBeyondHorizonS = 5.0F;  // our motion is carried on at constant speed until then
constexpr float kMovingMps = 1.0F;
constexpr float kZoneMarginM = 0.5F;
constexpr float kSeekM = 20.0F;      // each way of where we are along our path
constexpr float kSeekKnotM = 10.0F;  // ... and along theirs, beyond our way between knots
constexpr int kStepsPerKnot = 5;
static_assert(kStepsPerKnot * (kEgoKnots - 1) == kHorizonSteps, "the knots span the horizon");

}  // namespace

EgoMotion::EgoMotion(const scene::Scene& scene, const Parameters& parameters, float lead_s,
                     const Trajectory* plan)
    : scene_(scene), parameters_(parameters), plan_(plan) {
  const float ahead_m = 0.5F * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  if (plan != nullptr) {
    for (int i = 0; i < kEgoKnots; ++i) {
      const TrajectoryPoint& point = plan->points[i * kStepsPerKnot];
      centre_[i] = shift_ahead(point.rear_axle, ahead_m);
      speed_[i] = point.speed_mps;
    }
  } else {
    const float speed_mps = scene.ego.speed_mps;
    for (int i = 0; i < kEgoKnots; ++i) {
      const float time_s = lead_s + kEgoKnotS * static_cast<float>(i);
      centre_[i] = shift_ahead(scene.ego.rear_axle, ahead_m + speed_mps * time_s);
      speed_[i] = speed_mps;
    }
  }

  // Of our paths the one the motion ends on; without a plan the one we are on.
  float least_m = 1e6F;
  for (const scene::EgoPath& ego_path : scene.ego_paths) {
    if (plan == nullptr && ego_path.manoeuvre != scene::Manoeuvre::kKeep) continue;
    const Point end = position(plan != nullptr ? centre_[kEgoKnots - 1] : centre_[0]);
    const scene::Frenet frenet = scene::project(*scene.map, ego_path.path, end, ego_path.frenet.s_m, kFarM);
    if (abs(frenet.d_m) >= least_m) continue;
    least_m = abs(frenet.d_m);
    path_ = &ego_path;
  }
  if (path_ == nullptr) return;
  float s_m =
      scene::project(*scene.map, path_->path, position(centre_[0]), path_->frenet.s_m + ahead_m, kSeekM).s_m;
  for (int i = 0; i < kEgoKnots; ++i) {
    s_m_[i] = s_m;
    if (i + 1 < kEgoKnots) s_m += 0.5F * kEgoKnotS * (speed_[i] + speed_[i + 1]);
  }
}

EgoOnPath EgoMotion::on_path(const scene::LanePath& path, float their_s_m, const Track& track) const {
  EgoOnPath ego;
  if (distance(position(centre_[0]), position(track.centre)) > kFarM) return ego;
  bool there[kEgoKnots] = {};
  float s_m = 0.0F;
  float d_m = 0.0F;
  float turn_rad = 0.0F;
  const int projected = conditioned() ? kEgoKnots : 1;
  for (int i = 0; i < kEgoKnots; ++i) {
    if (i < projected) {
      // Between knots we move less than the reach; the first one looks at the whole path.
      const float reach_m = i == 0 ? -1.0F : kSeekKnotM + kEgoKnotS * speed_[i];
      const scene::Frenet frenet = scene::project(*scene_.map, path, position(centre_[i]), s_m, reach_m);
      s_m = frenet.s_m;
      d_m = frenet.d_m;
      turn_rad = wrap_angle(centre_[i].heading_rad - frenet.heading_rad);
    } else {
      s_m += kEgoKnotS * ego.speed_mps[0];  // keeps lane and speed as far as it is there already
    }
    const SinCos turn = sin_cos(turn_rad);
    const float half_length_m = 0.5F * parameters_.vehicle.length_m;
    const float half_width_m = 0.5F * parameters_.vehicle.width_m;
    const float along_m = half_length_m * abs(turn.cos) + half_width_m * abs(turn.sin);
    const float across_m = half_length_m * abs(turn.sin) + half_width_m * abs(turn.cos);
    // Who only crosses its path is a matter of zones and right of way, unless it stops there.
    const bool along = turn.cos > kAlongCos || speed_[i] < kMovingMps;
    there[i] = along && abs(d_m) < across_m + 0.5F * track.width_m + kSideMarginM;
    ego.centre_s_m[i] = s_m;
    ego.rear_s_m[i] = s_m - along_m;
    ego.speed_mps[i] = max(speed_[i] * turn.cos, 0.0F);
    ego.ever = ego.ever || there[i];
  }
  ego.from_start = there[0];
  ego.headway_s = kept_headway_s(ego.rear_s_m[0] - their_s_m - 0.5F * track.length_m, track.speed_mps);
  for (int i = 0; i < kEgoKnots; ++i) {
    ego.present[i] = there[i] || (i + 1 < kEgoKnots && there[i + 1]);
  }
  return ego;
}

bool EgoMotion::zone_on_our_path(const PathConflict& conflict, float& entry_s_m, float& exit_s_m) const {
  if (path_ == nullptr) return false;
  for (const scene::PathLane& part : path_->path.lanes) {
    if (part.lane != conflict.our_lane) continue;
    entry_s_m = part.start_s_m + conflict.our_entry_m;
    exit_s_m = part.start_s_m + conflict.our_exit_m;
    return true;
  }
  return false;
}

bool EgoMotion::inside(const PathConflict& conflict) const {
  float entry_s_m = 0.0F;
  float exit_s_m = 0.0F;
  if (!zone_on_our_path(conflict, entry_s_m, exit_s_m)) return false;
  return s_m_[0] > entry_s_m + kZoneMarginM && s_m_[0] < exit_s_m;
}

TimeInZone EgoMotion::time_in_zone(const PathConflict& conflict) const {
  TimeInZone ours;
  float entry_s_m = 0.0F;
  float exit_s_m = 0.0F;
  if (!zone_on_our_path(conflict, entry_s_m, exit_s_m) || s_m_[0] >= exit_s_m) return ours;
  const float end_mps = speed_[kEgoKnots - 1];
  const float end_s = kEgoKnotS * static_cast<float>(kEgoKnots - 1);
  // When the arc length `goal` is reached; kNeverS: we come to a stand before.
  const auto time_at = [&](float goal_s_m) {
    if (s_m_[0] >= goal_s_m) return 0.0F;
    for (int i = 0; i + 1 < kEgoKnots; ++i) {
      if (s_m_[i + 1] < goal_s_m) continue;
      const float part = (goal_s_m - s_m_[i]) / max(s_m_[i + 1] - s_m_[i], 1e-3F);
      return kEgoKnotS * (static_cast<float>(i) + clamp(part, 0.0F, 1.0F));
    }
    if (end_mps < kMovingMps) return occupancy::kNeverS;
    return end_s + (goal_s_m - s_m_[kEgoKnots - 1]) / end_mps;
  };
  const float entry_s = time_at(entry_s_m);
  if (entry_s > kBeyondHorizonS) return ours;
  ours.entry_s = entry_s;
  ours.exit_s = time_at(exit_s_m);
  return ours;
}

}  // namespace s4tp::satp
