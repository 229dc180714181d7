#include "algo/trajectory/tight_bends.hpp"

#include "algo/core/math.hpp"
#include "algo/scene/ego_paths.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kStepM = 1.5F;
constexpr int kMostSteps = 40;
constexpr float kNearM = 15.0F;       // of the middle of the bend
constexpr float kHalfWidthM = 0.9F;   // of a usual car
constexpr float kReachM = 4.0F;       // of our box and half a usual car, from our centre
constexpr float kWaitedForM = 20.0F;  // zones of the map so near are of the same junction

// Work (WorkMeter's units).
constexpr int kLaneWork = 6;
constexpr int kPlaceWork = 5;
constexpr int kApartWork = 1;
constexpr int kExtendWork = 25;

/// Extends the zone by our box at one place, where it reaches into the lane.
void extend(const Lane& lane, const Box& ours, float centre_s_m, bool& any, scene::ConflictZone& zone) {
  const Point ahead = direction(ours.centre.heading_rad);
  for (int corner = 0; corner < 4; ++corner) {
    const float along_m = corner < 2 ? 0.5F * ours.length_m : -0.5F * ours.length_m;
    const float left_m = corner % 2 == 0 ? 0.5F * ours.width_m : -0.5F * ours.width_m;
    const Point at{ours.centre.x_m + along_m * ahead.x_m - left_m * ahead.y_m,
                   ours.centre.y_m + along_m * ahead.y_m + left_m * ahead.x_m};
    const scene::LaneFix fix = scene::nearest_on_lane(lane, at);
    const bool beyond = fix.s_m <= 0.0F || fix.s_m >= lane.length_m;
    if (beyond || fix.distance_m > kHalfWidthM + kBesideRoomM) continue;
    if (!any) {
      any = true;
      zone.entry_s_m = centre_s_m - kStepM;
      zone.other_entry_m = lane.length_m;
      zone.other_exit_m = 0.0F;
    }
    zone.exit_s_m = centre_s_m + kStepM;
    zone.other_entry_m = min(zone.other_entry_m, fix.s_m - scene::kUsualHalfLengthM - kStepM);
    zone.other_exit_m = max(zone.other_exit_m, fix.s_m + scene::kUsualHalfLengthM + kStepM);
  }
}

/// Where our front waits for it: where the map has us wait for the junction.
float stop_s_m(const scene::EgoPath& path, float entry_s_m, const Parameters& parameters) {
  float stop_s_m = entry_s_m + 0.5F * parameters.vehicle.length_m - scene::kStopMarginM;
  for (const scene::ConflictZone& zone : path.zones) {
    if (abs(zone.entry_s_m - entry_s_m) < kWaitedForM) stop_s_m = min(stop_s_m, zone.stop_s_m);
  }
  return stop_s_m;
}

}  // namespace

int add_zones_beside(const scene::Scene& scene, const Parameters& parameters, scene::EgoPath& path) {
  const ReferenceLine& line = *path.driven;
  if (!line.tight) return 0;
  const float from_s_m = max(line.tight_from_s_m, path.frenet.s_m);
  const float middle_s_m = 0.5F * (line.tight_from_s_m + line.tight_to_s_m);
  const Point middle = position(reference_at(line, middle_s_m).pose);
  const int steps = to_int((line.tight_to_s_m - from_s_m) / kStepM, -1, kMostSteps - 1);
  Box ours[kMostSteps];
  for (int i = 0; i <= steps; ++i)
    ours[i] = box_on_line(path, from_s_m + static_cast<float>(i) * kStepM, parameters);
  int work = kPlaceWork * (steps + 1);
  for (LaneIndex index = 0; index < kMaxLanes; ++index) {
    const Lane& lane = scene.map->lanes[index];
    if (lane.in_junction || !scene::usable(lane) || scene::is_along(path.path, index)) continue;
    work += kLaneWork;
    const float away_m = scene::nearest_on_lane(lane, middle).distance_m;
    if (away_m > kNearM) continue;
    scene::ConflictZone zone;
    zone.other_lane = index;
    zone.priority = Priority::kFirstYields;
    zone.beside = true;
    bool any = false;
    for (int i = 0; i <= steps; ++i) {
      work += kApartWork;
      if (away_m - distance(middle, position(ours[i].centre)) > kReachM) continue;
      work += kLaneWork;
      if (scene::nearest_on_lane(lane, position(ours[i].centre)).distance_m > kReachM) continue;
      work += kExtendWork;
      const float s_m = from_s_m + static_cast<float>(i) * kStepM;
      extend(lane, ours[i], s_m + rear_axle_to_centre_m(parameters), any, zone);
    }
    if (!any) continue;
    zone.stop_s_m = stop_s_m(path, zone.entry_s_m, parameters);
    scene::add_zone(zone, path);
  }
  scene::sort_zones(path);
  return work;
}

}  // namespace s4tp::trajectory
