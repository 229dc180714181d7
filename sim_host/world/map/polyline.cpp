#include "sim_host/world/map/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace s4tp::map {
namespace {

constexpr double kSamePoint_m = 1e-6;

double distance_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double t = square > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/// Greedy: each chord reaches as far as all vertices under it stay within the tolerance.
std::vector<Vec2> thin_out(const std::vector<Vec2>& points, double tolerance_m) {
  std::vector<Vec2> kept{points.front()};
  std::size_t from = 0;
  while (from + 1 < points.size()) {
    std::size_t reach = from + 1;
    for (std::size_t to = from + 2; to < points.size(); ++to) {
      const bool within = std::all_of(
          points.begin() + static_cast<std::ptrdiff_t>(from) + 1,
          points.begin() + static_cast<std::ptrdiff_t>(to),
          [&](Vec2 p) { return distance_to_segment(p, points[from], points[to]) <= tolerance_m; });
      if (!within) {
        break;
      }
      reach = to;
    }
    kept.push_back(points[reach]);
    from = reach;
  }
  return kept;
}

}  // namespace

double wrap_angle(double angle_rad) {
  const double turn = 2.0 * std::numbers::pi;
  return angle_rad - turn * std::floor((angle_rad + std::numbers::pi) / turn);
}

Polyline::Polyline(const std::vector<Vec2>& points) {
  for (const Vec2& point : points) {
    if (points_.empty() ||
        std::hypot(point.x - points_.back().x, point.y - points_.back().y) > kSamePoint_m) {
      points_.push_back(point);
    }
  }
  if (points_.size() < 2) {
    throw std::invalid_argument("a polyline needs at least two different points");
  }
  arc_m_.push_back(0.0);
  std::vector<double> segment_heading;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const double dx = points_[i + 1].x - points_[i].x;
    const double dy = points_[i + 1].y - points_[i].y;
    arc_m_.push_back(arc_m_.back() + std::hypot(dx, dy));
    const double heading = std::atan2(dy, dx);
    segment_heading.push_back(i == 0 ? heading
                                     : segment_heading.back() + wrap_angle(heading - segment_heading.back()));
  }
  heading_rad_.push_back(segment_heading.front());
  for (std::size_t i = 1; i < segment_heading.size(); ++i) {
    heading_rad_.push_back(0.5 * (segment_heading[i - 1] + segment_heading[i]));
  }
  heading_rad_.push_back(segment_heading.back());
}

std::size_t Polyline::segment_at(double s_m) const {
  const auto after = std::upper_bound(arc_m_.begin() + 1, arc_m_.end() - 1, s_m);
  return static_cast<std::size_t>(after - arc_m_.begin()) - 1;
}

PolylinePose Polyline::at(double s_m) const {
  const double length = length_m();
  if (s_m < 0.0 || s_m > length) {
    const std::size_t end = s_m < 0.0 ? 0 : points_.size() - 1;
    const double beyond = s_m < 0.0 ? s_m : s_m - length;
    const double heading = heading_rad_[end];
    return {{points_[end].x + beyond * std::cos(heading), points_[end].y + beyond * std::sin(heading)},
            wrap_angle(heading),
            0.0};
  }
  const std::size_t i = segment_at(s_m);
  const double segment_m = arc_m_[i + 1] - arc_m_[i];
  const double t = (s_m - arc_m_[i]) / segment_m;
  const double turn = heading_rad_[i + 1] - heading_rad_[i];
  return {{points_[i].x + t * (points_[i + 1].x - points_[i].x),
           points_[i].y + t * (points_[i + 1].y - points_[i].y)},
          wrap_angle(heading_rad_[i] + t * turn),
          turn / segment_m};
}

PolylineProjection Polyline::project(Vec2 point) const {
  PolylineProjection best;
  double best_distance = std::numeric_limits<double>::infinity();
  const std::size_t last = points_.size() - 2;
  for (std::size_t i = 0; i <= last; ++i) {
    const double segment_m = arc_m_[i + 1] - arc_m_[i];
    const double ux = (points_[i + 1].x - points_[i].x) / segment_m;
    const double uy = (points_[i + 1].y - points_[i].y) / segment_m;
    const double rx = point.x - points_[i].x;
    const double ry = point.y - points_[i].y;
    const double low = i == 0 ? -std::numeric_limits<double>::infinity() : 0.0;
    const double high = i == last ? std::numeric_limits<double>::infinity() : segment_m;
    const double along = std::clamp(rx * ux + ry * uy, low, high);
    const double distance = std::hypot(rx - along * ux, ry - along * uy);
    if (distance < best_distance) {
      best_distance = distance;
      best = {arc_m_[i] + along, ux * ry - uy * rx < 0.0 ? -distance : distance};
    }
  }
  return best;
}

Polyline Polyline::simplified(int count, double tolerance_m) const {
  std::vector<Vec2> kept = thin_out(points_, tolerance_m);
  const std::size_t wanted = static_cast<std::size_t>(std::max(count, 2));
  double too_fine = tolerance_m;
  double wide_enough = length_m();  // one chord: no vertex is further from it than the line is long
  if (kept.size() > wanted) {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (too_fine + wide_enough);
      (thin_out(points_, middle).size() > wanted ? too_fine : wide_enough) = middle;
    }
    kept = thin_out(points_, wide_enough);
  }
  return Polyline(kept);
}

Polyline Polyline::part(double from_m, double to_m) const {
  const double from = std::clamp(from_m, 0.0, length_m());
  const double to = std::clamp(to_m, 0.0, length_m());
  std::vector<Vec2> inside{at(from).point};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (arc_m_[i] > from + kSamePoint_m && arc_m_[i] < to - kSamePoint_m) {
      inside.push_back(points_[i]);
    }
  }
  inside.push_back(at(to).point);
  return Polyline(inside);
}

}  // namespace s4tp::map
