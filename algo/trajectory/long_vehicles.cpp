#include "algo/trajectory/long_vehicles.hpp"

#include "algo/core/math.hpp"
#include "algo/scene/ego_paths.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {
namespace {

constexpr float kPlaceM = 1.0F;  // from one place of the vehicle to the next, and ...
constexpr int kMostPlaces = 40;
constexpr float kStepM = 0.5F;       // of our box
constexpr float kFurthestM = 12.0F;  // that our ground grows to either side
constexpr float kSpareM = 0.1F;      // between the boxes
constexpr float kRoomM = 1.0F;       // to stand in before it
constexpr float kBendRad = 0.2F;     // who turns by less takes no more than its lane

// Work (WorkMeter's units).
constexpr int kLookWork = 1;
constexpr int kBendWork = 20;
constexpr int kPlaceWork = 8;
constexpr int kTouchWork = 7;

/// A vehicle on its way through a zone: from where to where its centre goes on `way`.
struct Sweep {
  const scene::LanePath& way;
  float from_s_m;
  float to_s_m;
  float length_m;
  float width_m;
};

struct Ground {
  float entry_s_m;
  float exit_s_m;
};

bool bends(const LaneMap& map, const Sweep& sweep) {
  const float half_m = 0.5F * sweep.length_m;
  const float before_rad = scene::path_point(map, sweep.way, sweep.from_s_m - half_m).pose.heading_rad;
  const float behind_rad = scene::path_point(map, sweep.way, sweep.to_s_m + half_m).pose.heading_rad;
  return abs(wrap_angle(behind_rad - before_rad)) > kBendRad;
}

/// With its front on the way, headed away from where its rear should be on it; in a bend the rear sticks out.
Box box_between(Point rear, Point front, const Sweep& sweep) {
  const float heading_rad = atan2(front.y_m - rear.y_m, front.x_m - rear.x_m);
  const Point middle = front - 0.5F * sweep.length_m * direction(heading_rad);
  return {{middle.x_m, middle.y_m, heading_rad}, sweep.length_m, sweep.width_m};
}

/// Grows our ground by where our box touches the vehicle's on its way. \return what it took [WorkMeter's units]
int grow(const scene::Scene& scene, const scene::EgoPath& path, const Sweep& sweep,
         const Parameters& parameters, Ground& ground) {
  const float centre_m = rear_axle_to_centre_m(parameters);
  const float half_m = 0.5F * sweep.length_m;
  const float first_s_m = ground.entry_s_m - kFurthestM;
  const float last_s_m = ground.exit_s_m + kFurthestM;
  const float span_m = sweep.to_s_m - sweep.from_s_m;
  const int places = to_int(span_m / kPlaceM, 1, kMostPlaces);
  scene::PathCursor rear(*scene.map, sweep.way);
  scene::PathCursor front(*scene.map, sweep.way);
  int work = (places + 1) * kPlaceWork;
  for (int i = 0; i <= places; ++i) {
    const float s_m = sweep.from_s_m + span_m * static_cast<float>(i) / static_cast<float>(places);
    const Box its =
        box_between(position(rear.at(s_m - half_m).pose), position(front.at(s_m + half_m).pose), sweep);
    const auto touches = [&](float own_s_m) {
      work += kTouchWork;
      const Box ours = box_on_line(path, own_s_m - centre_m, parameters);
      return separation(ours, its) < kSpareM;
    };
    while (ground.entry_s_m > first_s_m && touches(ground.entry_s_m - kStepM)) ground.entry_s_m -= kStepM;
    while (ground.exit_s_m < last_s_m && touches(ground.exit_s_m + kStepM)) ground.exit_s_m += kStepM;
  }
  return work + (rear.seeks() + front.seeks()) * scene::kSeekWork;
}

}  // namespace

int widen_zones(const scene::Scene& scene, const Parameters& parameters, float lead_s, scene::EgoPath& path) {
  const float speed_mps = scene.ego.speed_mps;
  const float nearest_s_m = path.frenet.s_m + rear_axle_to_centre_m(parameters) + kRoomM +
                            speed_mps * (lead_s + parameters.guard.takeover_s) +
                            0.5F * square(speed_mps) / parameters.guard.braking_mps2;
  const float front_m = 0.5F * parameters.vehicle.length_m;
  int work = 0;
  int pairs = 0;
  for (const scene::Agent& agent : scene.agents) {
    if (agent.track.length_m < kLongM) continue;
    const float longer_m = 0.5F * agent.track.length_m - scene::kUsualHalfLengthM;
    for (int k = 0; k < agent.paths.size() * path.zones.size(); ++k) {
      scene::ConflictZone& zone = path.zones[k % path.zones.size()];
      const int way = k / path.zones.size();
      float start_s_m = 0.0F;
      work += kLookWork;
      if (zone.beside) continue;
      if (!lane_start(agent.paths[way], zone.other_lane, start_s_m)) continue;
      const Sweep sweep{agent.paths[way],
                        max(start_s_m + zone.other_entry_m - longer_m, agent.frenet[way].s_m),
                        start_s_m + zone.other_exit_m + longer_m, agent.track.length_m, agent.track.width_m};
      work += kBendWork;
      if (sweep.from_s_m >= sweep.to_s_m || !bends(*scene.map, sweep) || pairs == kMostSwept) continue;
      ++pairs;
      Ground ground{zone.entry_s_m, zone.exit_s_m};
      work += grow(scene, path, sweep, parameters, ground);
      zone.entry_s_m = min(zone.entry_s_m, max(ground.entry_s_m, nearest_s_m));
      zone.exit_s_m = ground.exit_s_m;
      zone.stop_s_m = min(zone.stop_s_m, zone.entry_s_m + front_m - scene::kStopMarginM);
    }
  }
  if (pairs > 0) scene::sort_zones(path);
  return work;
}

}  // namespace s4tp::trajectory
