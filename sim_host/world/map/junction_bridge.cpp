#include <algorithm>
#include <cmath>

#include "sim_host/world/map/junction_links.hpp"

namespace s4tp::map {
namespace {

constexpr double kTouching_m = 0.1;
constexpr double kSideways_mps2 = 5.5;  // netconvert's limit of the speed in turns
constexpr int kPoints = 20;

constexpr double kCorner_rad = 0.17;  // 10 degrees between two pieces of a line
constexpr double kClose_m = 2.0;  // of a sharp turn of 120 degrees; still on the paved ground of its junction

bool has_corner(const Polyline& line) {
  const std::vector<Vec2>& points = line.points();
  for (std::size_t i = 2; i < points.size(); ++i) {
    const double before = std::atan2(points[i - 1].y - points[i - 2].y, points[i - 1].x - points[i - 2].x);
    const double after = std::atan2(points[i].y - points[i - 1].y, points[i].x - points[i - 1].x);
    if (std::abs(wrap_angle(after - before)) > kCorner_rad) {
      return true;
    }
  }
  return false;
}

bool close_to(const Polyline& line, const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](Vec2 point) {
    const PolylineProjection at = line.project(point);
    const double beyond_m = std::max({0.0, -at.s_m, at.s_m - line.length_m()});
    return std::abs(at.d_m) + beyond_m < kClose_m;
  });
}

}  // namespace

void round_turn(Lane& turn, const Lane& from, const Lane& to) {
  if (!has_corner(turn.centre)) {
    return;
  }
  const std::optional<Lane> arc = bridge_between(from, to);
  if (arc && close_to(arc->centre, turn.centre.points())) {
    turn.centre = arc->centre;
  }
}

std::optional<Lane> bridge_between(const Lane& from, const Lane& to) {
  const PolylinePose start = from.centre.at(from.centre.length_m());
  const PolylinePose end = to.centre.at(0.0);
  const double chord_m = std::hypot(end.point.x - start.point.x, end.point.y - start.point.y);
  if (chord_m < kTouching_m) {
    return std::nullopt;
  }
  // The cubic that comes nearest to a circle's arc; its handles are a third of the chord when straight.
  const double turn_rad = std::abs(wrap_angle(end.heading_rad - start.heading_rad));
  const double sine = std::sin(0.5 * turn_rad);
  const double handle_m =
      sine > 1e-3 ? chord_m * 4.0 / 3.0 * std::tan(0.25 * turn_rad) / (2.0 * sine) : chord_m / 3.0;
  const Vec2 a = start.point;
  const Vec2 b{a.x + handle_m * std::cos(start.heading_rad), a.y + handle_m * std::sin(start.heading_rad)};
  const Vec2 d = end.point;
  const Vec2 c{d.x - handle_m * std::cos(end.heading_rad), d.y - handle_m * std::sin(end.heading_rad)};
  std::vector<Vec2> points;
  for (int i = 0; i <= kPoints; ++i) {
    const double t = static_cast<double>(i) / kPoints;
    const double u = 1.0 - t;
    const auto blend = [&](double p, double q, double r, double s) {
      return u * u * u * p + 3.0 * u * u * t * q + 3.0 * u * t * t * r + t * t * t * s;
    };
    points.push_back({blend(a.x, b.x, c.x, d.x), blend(a.y, b.y, c.y, d.y)});
  }
  Lane bridge;
  bridge.in_junction = true;
  bridge.centre = Polyline(points);
  bridge.drawn = bridge.centre;
  bridge.sumo_length_m = bridge.centre.length_m();
  bridge.width_m = std::min(from.width_m, to.width_m);
  bridge.speed_limit_mps = std::min(from.speed_limit_mps, to.speed_limit_mps);
  if (sine > 1e-3) {
    bridge.speed_limit_mps =
        std::min(bridge.speed_limit_mps, std::sqrt(kSideways_mps2 * chord_m / (2.0 * sine)));
  }
  return bridge;
}

}  // namespace s4tp::map
