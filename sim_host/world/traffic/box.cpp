#include "sim_host/world/traffic/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace s4tp::traffic {
namespace {

using map::Vec2;

constexpr double kCompetitionLength_m = 3.68;
constexpr double kCompetitionWidth_m = 1.47;

Vec2 direction(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}

/// Half the box's extent along a unit axis.
double reach(const Box& box, Vec2 axis) {
  const Vec2 ahead = direction(box.heading_rad);
  return 0.5 * box.length_m * std::abs(dot(ahead, axis)) +
         0.5 * box.width_m * std::abs(-ahead.y * axis.x + ahead.x * axis.y);
}

std::array<Vec2, 4> axes(const Box& a, const Box& b) {
  const Vec2 u = direction(a.heading_rad);
  const Vec2 v = direction(b.heading_rad);
  return {{u, {-u.y, u.x}, v, {-v.y, v.x}}};
}

double point_to_box_m(Vec2 point, const Box& box) {
  const Vec2 ahead = direction(box.heading_rad);
  const Vec2 from_centre = {point.x - box.centre.x, point.y - box.centre.y};
  const double along = std::abs(dot(from_centre, ahead)) - 0.5 * box.length_m;
  const double across = std::abs(-ahead.y * from_centre.x + ahead.x * from_centre.y) - 0.5 * box.width_m;
  return std::hypot(std::max(along, 0.0), std::max(across, 0.0));
}

}  // namespace

Box box_of(const CarState& car) {
  return {car.centre, car.heading_rad, car.length_m, car.width_m};
}

Box competition_box_of(const CarState& car) {
  return {car.centre, car.heading_rad, kCompetitionLength_m, kCompetitionWidth_m};
}

std::array<Vec2, 4> corners(const Box& box) {
  const Vec2 u = direction(box.heading_rad);
  const double l = 0.5 * box.length_m;
  const double w = 0.5 * box.width_m;
  const auto corner = [&](double along, double across) -> Vec2 {
    return {box.centre.x + along * u.x - across * u.y, box.centre.y + along * u.y + across * u.x};
  };
  return {{corner(l, w), corner(-l, w), corner(-l, -w), corner(l, -w)}};
}

bool overlap(const Box& a, const Box& b) {
  const Vec2 between = {b.centre.x - a.centre.x, b.centre.y - a.centre.y};
  const double far = 0.5 * (a.length_m + a.width_m + b.length_m + b.width_m);
  if (std::abs(between.x) > far || std::abs(between.y) > far) {
    return false;
  }
  const auto both = axes(a, b);
  return std::none_of(both.begin(), both.end(), [&](Vec2 axis) {
    return std::abs(dot(between, axis)) > reach(a, axis) + reach(b, axis);
  });
}

double distance_m(const Box& a, const Box& b) {
  if (overlap(a, b)) {
    return 0.0;
  }
  double least =
      std::numeric_limits<double>::infinity();  // between convex outlines a corner is always part of it
  for (const Vec2 corner : corners(a)) {
    least = std::min(least, point_to_box_m(corner, b));
  }
  for (const Vec2 corner : corners(b)) {
    least = std::min(least, point_to_box_m(corner, a));
  }
  return least;
}

bool crosses(const Box& box, Vec2 from, Vec2 to) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  return overlap(box, {{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)},
                       std::atan2(to.y - from.y, to.x - from.x),
                       length,
                       0.0});
}

bool hidden(const CarState& from, const CarState& car, const std::vector<CarState>& others) {
  const auto blocked = [&](Vec2 point) {
    return std::any_of(others.begin(), others.end(), [&](const CarState& between) {
      return between.id != car.id && between.id != from.id && crosses(box_of(between), from.centre, point);
    });
  };
  const auto points = corners(box_of(car));
  return blocked(car.centre) && std::all_of(points.begin(), points.end(), blocked);
}

double time_to_contact_s(const Box& a, Vec2 velocity_a, const Box& b, Vec2 velocity_b) {
  const Vec2 between = {b.centre.x - a.centre.x, b.centre.y - a.centre.y};
  const Vec2 relative = {velocity_b.x - velocity_a.x, velocity_b.y - velocity_a.y};
  double first = 0.0;
  double last = std::numeric_limits<double>::infinity();
  for (const Vec2 axis : axes(a, b)) {
    const double offset = dot(between, axis);
    const double speed = dot(relative, axis);
    const double reaches = reach(a, axis) + reach(b, axis);
    if (std::abs(speed) < 1e-9) {
      if (std::abs(offset) > reaches) {
        return std::numeric_limits<double>::infinity();
      }
      continue;
    }
    const double one = (-reaches - offset) / speed;
    const double two = (reaches - offset) / speed;
    first = std::max(first, std::min(one, two));
    last = std::min(last, std::max(one, two));
  }
  return first <= last ? first : std::numeric_limits<double>::infinity();
}

}  // namespace s4tp::traffic
