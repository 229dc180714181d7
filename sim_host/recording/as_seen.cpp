#include "sim_host/recording/as_seen.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace s4tp::recording {
namespace {

constexpr int kTicksPerSnapshot = 10;

traffic::CarState state_of(const Track& track) {
  traffic::CarState car;
  car.id = track.id;
  car.centre = {track.centre.x_m, track.centre.y_m};
  car.heading_rad = track.centre.heading_rad;
  car.speed_mps = track.speed_mps;
  car.acceleration_mps2 = track.acceleration_mps2;
  car.yaw_rate_radps = track.yaw_rate_radps;
  car.length_m = track.length_m;
  car.width_m = track.width_m;
  return car;
}

traffic::CarState state_of(const EgoState& ego, const Parameters& parameters) {
  const double ahead_m = 0.5 * parameters.vehicle.length_m - parameters.vehicle.rear_overhang_m;
  traffic::CarState car;
  car.heading_rad = ego.rear_axle.heading_rad;
  car.centre = {ego.rear_axle.x_m + ahead_m * std::cos(car.heading_rad),
                ego.rear_axle.y_m + ahead_m * std::sin(car.heading_rad)};
  car.speed_mps = ego.speed_mps;
  car.acceleration_mps2 = ego.acceleration_mps2;
  car.yaw_rate_radps = ego.yaw_rate_radps;
  car.length_m = parameters.vehicle.length_m;
  car.width_m = parameters.vehicle.width_m;
  return car;
}

}  // namespace

traffic::Snapshot snapshot_of(const ecu::EcuCore& core, const Parameters& parameters) {
  const ecu::Inputs& inputs = core.inputs();
  traffic::Snapshot now;
  now.ego = state_of(inputs.ego(), parameters);
  now.ego_steering_rad = inputs.ego().steering_rad;
  for (const Track& track : inputs.tracks()) now.others.push_back(state_of(track));
  return now;
}

void AsSeen::look(const ecu::EcuCore& core, const Parameters& parameters, double time_s) {
  const ecu::Inputs& inputs = core.inputs();
  clock_s_ = core.now_ms() / 1000.0 - time_s;
  if (ticks_++ % kTicksPerSnapshot != 0 || !inputs.ego_known()) return;
  recording_.snapshots.push_back(snapshot_of(core, parameters));
  recording_.snapshots.back().time_s = time_s;
  const wire::Map* const map = inputs.map();
  if (map != nullptr && inputs.map_revision() != revision_) {
    revision_ = inputs.map_revision();
    keep_lanes(*map);
  }
}

traffic::Recording AsSeen::recording() const {
  traffic::Recording seen = recording_;
  if (seen.snapshots.empty()) return seen;
  // A page counts a plan's time from vehicle time, which began so long before.
  seen.snapshots.insert(seen.snapshots.begin(), seen.snapshots.front());
  seen.snapshots.front().time_s = -clock_s_;
  seen.goal = seen.snapshots.back().ego.centre;
  return seen;
}

void AsSeen::keep_lanes(const wire::Map& map) {
  for (const wire::Lane& lane : map.lanes) {
    if (!lane.present || lane.point_count < 2) continue;
    std::vector<map::Vec2> points;
    for (int i = 0; i < lane.point_count; ++i) points.push_back({lane.x_m[i], lane.y_m[i]});
    const map::Vec2 first = points.front();
    const map::Vec2 last = points.back();
    const std::array<long, 4> ends{std::lround(first.x), std::lround(first.y), std::lround(last.x),
                                   std::lround(last.y)};
    if (!known_.insert(ends).second) continue;
    try {
      map::Lane drawn;
      drawn.centre = map::Polyline(points);
      drawn.width_m = lane.width_m;
      drawn.in_junction = lane.in_junction;
      scenario_.network.lanes.push_back(std::move(drawn));
    } catch (const std::invalid_argument&) {  // all in one point: nothing to draw
    }
  }
}

}  // namespace s4tp::recording
