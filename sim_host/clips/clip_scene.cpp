#include "sim_host/clips/clip_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "algo/scene/scene_builder.hpp"
#include "sim_host/clips/forecaster.hpp"
#include "sim_host/world/traffic/box.hpp"

namespace s4tp::clips {
namespace {

constexpr double kReach_m = 120.0;   // of the map around the vehicle
constexpr double kCorridor_m = 2.0;  // beside its heading: who is ahead in it is its leader
constexpr double kSmoothed_s = 0.5;  // over which rates are taken: recorded speeds are noisy
constexpr int kSmoothedSteps = 5;
constexpr double kAxle_m = 1.5;  // rear axle behind our box centre
constexpr double kNobodyAway_m = 80.0;

float single(double value) {
  return static_cast<float>(value);
}

/// The lanes around a place, as the map node would send them, conflicts apart: clips have none.
void fill_map(const Clip& clip, map::Vec2 origin, LaneMap& map) {
  std::vector<std::pair<double, int>> near;
  for (std::size_t i = 0; i < clip.lanes.size(); ++i) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const map::Vec2 point : clip.lanes[i].centre.points()) {
      nearest_m = std::min(nearest_m, std::hypot(point.x - origin.x, point.y - origin.y));
    }
    if (nearest_m < kReach_m) near.emplace_back(nearest_m, static_cast<int>(i));
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min<std::size_t>(near.size(), kMaxLanes));
  const auto slot_of = [&](int lane) {
    const auto found =
        std::find_if(near.begin(), near.end(), [&](const auto& one) { return one.second == lane; });
    return found == near.end() ? kNoLaneIndex : static_cast<LaneIndex>(found - near.begin());
  };
  for (std::size_t slot = 0; slot < near.size(); ++slot) {
    const ClipLane& from = clip.lanes[static_cast<std::size_t>(near[slot].second)];
    Lane& lane = map.lanes[slot];
    const map::Polyline line = from.centre.simplified(kMaxLanePoints, 0.05);
    for (const map::Vec2 point : line.points()) {
      lane.points[lane.point_count++] = {single(point.x - origin.x), single(point.y - origin.y)};
    }
    lane.present = true;
    lane.width_m = single(std::clamp(from.width_m, 2.5, 5.0));
    lane.speed_limit_mps = single(from.speed_limit_mps);
    lane.length_m = scene::centre_line_length(lane);
    int count = 0;
    for (const int next : from.successors) {
      if (count < kMaxSuccessors && slot_of(next) != kNoLaneIndex) lane.successors[count++] = slot_of(next);
    }
    if (from.left >= 0) lane.left = slot_of(from.left);
    if (from.right >= 0) lane.right = slot_of(from.right);
  }
}

Track track_of(const ClipVehicle& vehicle, int step, map::Vec2 origin, std::uint8_t id) {
  const ClipState& state = vehicle.states.at(step);
  const auto before = vehicle.states.find(step - kSmoothedSteps);
  Track track;
  track.id = id;
  track.centre = {single(state.centre.x - origin.x), single(state.centre.y - origin.y),
                  single(map::wrap_angle(state.heading_rad))};
  track.speed_mps = single(std::clamp(state.speed_mps, 0.0, 60.0));
  if (before != vehicle.states.end()) {
    const double turned = map::wrap_angle(state.heading_rad - before->second.heading_rad);
    track.acceleration_mps2 =
        single(std::clamp((state.speed_mps - before->second.speed_mps) / kSmoothed_s, -12.0, 12.0));
    track.yaw_rate_radps = single(std::clamp(turned / kSmoothed_s, -1.2, 1.2));
  }
  track.length_m = single(std::clamp(vehicle.length_m, 1.0, 25.0));
  track.width_m = single(std::clamp(vehicle.width_m, 0.5, 3.0));
  return track;
}

EgoState ego_of(const Track& track) {
  EgoState ego;
  ego.rear_axle = shift_ahead(track.centre, single(-kAxle_m));
  ego.speed_mps = track.speed_mps;
  ego.acceleration_mps2 = track.acceleration_mps2;
  ego.yaw_rate_radps = track.yaw_rate_radps;
  return ego;
}

/// Who matters to a vehicle: its leader, then who is nearest; seen in all of the last second.
std::vector<std::size_t> around(const Clip& clip, std::size_t vehicle, int step) {
  const ClipState& self = clip.vehicles[vehicle].states.at(step);
  std::vector<std::pair<double, std::size_t>> near;
  std::size_t leader = vehicle;
  double leader_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < clip.vehicles.size(); ++i) {
    if (i == vehicle || !clip.vehicles[i].seen(step - kPastSteps, step)) continue;
    const ClipState& other = clip.vehicles[i].states.at(step);
    const double x = other.centre.x - self.centre.x;
    const double y = other.centre.y - self.centre.y;
    const double ahead_m = x * std::cos(self.heading_rad) + y * std::sin(self.heading_rad);
    const double left_m = y * std::cos(self.heading_rad) - x * std::sin(self.heading_rad);
    near.emplace_back(std::hypot(x, y), i);
    if (ahead_m <= 0.0 || std::abs(left_m) > kCorridor_m || ahead_m >= leader_m) continue;
    leader = i;
    leader_m = ahead_m;
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> result;
  if (leader != vehicle) result.push_back(leader);
  for (const auto& [distance_m, i] : near) {
    if (i != leader && result.size() < kMaxAgents) result.push_back(i);
  }
  return result;
}

}  // namespace

map::Vec2 see(const Clip& clip, std::size_t vehicle, int step, const Parameters& parameters, LaneMap& map,
              scene::Scene& scene) {
  const map::Vec2 origin = clip.vehicles[vehicle].states.at(step).centre;
  fill_map(clip, origin, map);
  std::vector<std::size_t> others = around(clip, vehicle, step);
  // All watched: the vehicle itself and four more; the last one found stands in our place.
  const bool alone = others.empty();
  const std::size_t ego = alone ? vehicle : others.back();
  if (!alone) others.pop_back();
  scene::SceneBuilder builder;
  builder.relevance = scene::Relevance::kNearest;
  for (int j = -kPastSteps; j <= 0; ++j) {
    const auto time_ms = static_cast<std::uint32_t>((kPastSteps + j + 1) * kStepMs);
    TrackList tracks;
    (void)tracks.push(track_of(clip.vehicles[vehicle], step + j, origin, kAskedTrack));
    for (std::size_t i = 0; i < others.size(); ++i) {
      (void)tracks.push(track_of(clip.vehicles[others[i]], step + j, origin,
                                 static_cast<std::uint8_t>(kAskedTrack + 1 + i)));
    }
    Track we = track_of(clip.vehicles[ego], step + j, origin, 0);
    if (alone) we.centre = shift_ahead(we.centre, single(-kNobodyAway_m));
    // Off every lane it is still a scene.
    (void)builder.build(time_ms, ego_of(we), tracks, time_ms, &map, parameters, scene);
  }
  return origin;
}

}  // namespace s4tp::clips
