#include "sim_host/world/traffic/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "sim_host/world/traffic/box.hpp"

namespace s4tp::traffic {
namespace {

using map::Vec2;

constexpr double kWithLane_rad = 1.2;  // further turned a car is not driving along the lane
constexpr double kPerRad_m = 2.0;      // what a radian of heading error counts against a metre of offset
constexpr double kNotOnRoute_m = 1.0;
constexpr double kNotFollowing_m = 1.0;
constexpr double kReachesIn_m = 0.3;  // of a box in a lane before others count it as being there

double cross(Vec2 o, Vec2 a, Vec2 b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Andrew's monotone chain, counter-clockwise.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const Vec2 point : points) {
      while (hull.size() >= base + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// ":centre_4" belongs to junction ":centre".
std::string junction_of(const map::Lane& lane) {
  return lane.edge.substr(0, lane.edge.rfind('_'));
}

}  // namespace

Locator::Locator(const map::Network& network, const map::RouteGuide& guide)
    : network_(network), guide_(guide) {
  for (const map::Lane& lane : network.lanes) {
    Bounds bounds{lane.centre.points().front(), lane.centre.points().front()};
    for (const Vec2 point : lane.centre.points()) {
      bounds.low = {std::min(bounds.low.x, point.x), std::min(bounds.low.y, point.y)};
      bounds.high = {std::max(bounds.high.x, point.x), std::max(bounds.high.y, point.y)};
    }
    bounds_.push_back(bounds);
  }
  add_junction_hulls();
}

void Locator::add_junction_hulls() {
  std::map<std::string, std::vector<Vec2>> hulls;
  for (const map::Lane& lane : network_.lanes) {
    if (!lane.in_junction) {
      continue;
    }
    std::vector<Vec2>& hull = hulls[junction_of(lane)];
    for (double s = 0.0; s <= lane.centre.length_m(); s += 0.5) {
      const map::PolylinePose pose = lane.centre.at(s);
      for (const double side : {-0.5, 0.5}) {
        hull.push_back({pose.point.x - side * lane.width_m * std::sin(pose.heading_rad),
                        pose.point.y + side * lane.width_m * std::cos(pose.heading_rad)});
      }
    }
    hull = convex_hull(hull);
  }
  for (auto& [junction, hull] : hulls) {
    hulls_.push_back(std::move(hull));
  }
}

bool Locator::near(std::size_t lane, Vec2 point, double margin_m) const {
  const Bounds& b = bounds_[lane];
  return point.x > b.low.x - margin_m && point.x < b.high.x + margin_m && point.y > b.low.y - margin_m &&
         point.y < b.high.y + margin_m;
}

LanePlace Locator::locate(Vec2 centre, double heading_rad, map::LaneId before) const {
  LanePlace best;
  LanePlace nearest;
  double best_cost = std::numeric_limits<double>::infinity();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < network_.lanes.size(); ++i) {
    const map::Lane& lane = network_.lanes[i];
    const map::LaneId id = static_cast<map::LaneId>(i);
    if (!near(i, centre, 3.0 * lane.width_m)) {
      continue;
    }
    const map::PolylineProjection at = lane.centre.project(centre);
    const double beyond_m = std::max({0.0, -at.s_m, at.s_m - lane.centre.length_m()});
    const double away_m = std::abs(at.d_m) + beyond_m;
    if (away_m < nearest_m) {
      nearest_m = away_m;
      nearest = {id, at.s_m, at.d_m, false};
    }
    const double turned_rad = std::abs(map::wrap_angle(heading_rad - lane.centre.at(at.s_m).heading_rad));
    if (std::abs(at.d_m) > 0.5 * lane.width_m || beyond_m > 0.0 || turned_rad > kWithLane_rad) {
      continue;
    }
    const auto& from = before == map::kNoLane ? std::vector<map::LaneId>{}
                                              : network_.lanes[static_cast<std::size_t>(before)].successors;
    const bool follows = id == before || std::find(from.begin(), from.end(), id) != from.end();
    const double cost = std::abs(at.d_m) + kPerRad_m * turned_rad +
                        (guide_.advice(id).on_route ? 0.0 : kNotOnRoute_m) +
                        (follows ? 0.0 : kNotFollowing_m);
    if (cost < best_cost) {
      best_cost = cost;
      best = {id, at.s_m, at.d_m, true};
    }
  }
  return best.lane != map::kNoLane ? best : nearest;
}

bool Locator::off_road(Vec2 centre) const {
  for (std::size_t i = 0; i < network_.lanes.size(); ++i) {
    const map::Lane& lane = network_.lanes[i];
    if (!near(i, centre, lane.width_m)) {
      continue;
    }
    const map::PolylineProjection at = lane.centre.project(centre);
    const double beyond_m = std::max({0.0, -at.s_m, at.s_m - lane.centre.length_m()});
    if (std::abs(at.d_m) <= lane.width_m && beyond_m <= 0.5 * lane.width_m) {
      return false;
    }
  }
  return std::none_of(hulls_.begin(), hulls_.end(), [&](const std::vector<Vec2>& hull) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      if (cross(hull[i], hull[(i + 1) % hull.size()], centre) < 0.0) {
        return false;
      }
    }
    return !hull.empty();
  });
}

Actor Locator::actor(const CarState& ego, const LanePlace& place) const {
  Actor actor;
  actor.id = ego.id;
  actor.lane = place.lane;
  actor.s_m = place.s_m;
  actor.speed_mps = ego.speed_mps;
  actor.length_m = ego.length_m;
  actor.guide = &guide_;
  if (place.lane == map::kNoLane) {
    return actor;
  }
  const map::Lane& lane = network_.lanes[static_cast<std::size_t>(place.lane)];
  for (const map::LaneId beside : {lane.left, lane.right}) {
    if (beside == map::kNoLane) {
      continue;
    }
    const map::Lane& other = network_.lanes[static_cast<std::size_t>(beside)];
    const map::PolylineProjection at = other.centre.project(ego.centre);
    if (std::abs(at.d_m) < 0.5 * (other.width_m + ego.width_m) - kReachesIn_m) {
      actor.also.push_back({beside, -at.s_m});
    }
  }
  return actor;
}

}  // namespace s4tp::traffic
