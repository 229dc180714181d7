#include "sim_host/sumo/ego_reach.hpp"

#include <algorithm>
#include <cmath>

namespace s4tp::sumo {
namespace {

constexpr double kMostLonger_m = 5.0;
constexpr std::size_t kMostLanes = 4;
constexpr double kStep_m = 0.25;
constexpr double kAsNear_m = 0.3;  // of two places on a bent line SUMO may take either

double furthest_m(const map::Polyline& line, map::Vec2 point) {
  const map::PolylineProjection nearest = line.project(point);
  double furthest = nearest.s_m;
  for (double s_m = nearest.s_m; s_m < line.length_m(); s_m += kStep_m) {
    const map::Vec2 there = line.at(s_m).point;
    if (std::hypot(there.x - point.x, there.y - point.y) < std::abs(nearest.d_m) + kAsNear_m) furthest = s_m;
  }
  return furthest;
}

}  // namespace

map::Vec2 ahead_of(const traffic::CarState& car, double distance_m) {
  return {car.centre.x + distance_m * std::cos(car.heading_rad),
          car.centre.y + distance_m * std::sin(car.heading_rad)};
}

void EgoReach::follow(map::LaneId id) {
  if (id == map::kNoLane) {
    lanes_.clear();
    return;
  }
  if (!lanes_.empty() && lanes_.back() == id) return;
  if (!lanes_.empty()) {
    const std::vector<map::LaneId>& next = lane(lanes_.back()).successors;
    if (std::find(next.begin(), next.end(), id) == next.end()) lanes_.clear();
  }
  lanes_.push_back(id);
  if (lanes_.size() > kMostLanes) lanes_.erase(lanes_.begin());
}

double EgoReach::length_m(const traffic::CarState& ego) const {
  if (lanes_.size() < 2) return ego.length_m;
  const map::Vec2 rear = ahead_of(ego, -0.5 * ego.length_m);
  double rear_m = 0.0;
  double nearest_m = INFINITY;
  double before_m = 0.0;  // all lanes' length before this one
  for (const map::LaneId id : lanes_) {
    const map::PolylineProjection at = lane(id).drawn.project(rear);
    if (std::abs(at.d_m) < nearest_m) {
      nearest_m = std::abs(at.d_m);
      rear_m = before_m + at.s_m;
    }
    before_m += lane(id).drawn.length_m();
  }
  const map::Polyline& last = lane(lanes_.back()).drawn;
  const double front_m = before_m - last.length_m() + furthest_m(last, ahead_of(ego, 0.5 * ego.length_m));
  return std::clamp(front_m - rear_m, ego.length_m, ego.length_m + kMostLonger_m);
}

}  // namespace s4tp::sumo
