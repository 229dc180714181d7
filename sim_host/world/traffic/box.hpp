#pragma once
/// Oriented boxes in the plane: cars as collisions, occlusion and metrics see them.

#include <array>

#include "sim_host/world/map/polyline.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::traffic {

struct Box {
  map::Vec2 centre;
  double heading_rad = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;
};

[[nodiscard]] Box box_of(const CarState& car);
/// The competition's size for the same car: 3.68 x 1.47 m.
[[nodiscard]] Box competition_box_of(const CarState& car);

[[nodiscard]] std::array<map::Vec2, 4> corners(const Box& box);
[[nodiscard]] bool overlap(const Box& a, const Box& b);
/// Shortest distance between the two outlines; 0 when they overlap.
[[nodiscard]] double distance_m(const Box& a, const Box& b);
/// Whether the straight line between two points meets the box.
[[nodiscard]] bool crosses(const Box& box, map::Vec2 from, map::Vec2 to);
/// Whether others hide one car from another one: it is seen as soon as its centre or a corner is.
[[nodiscard]] bool hidden(const CarState& from, const CarState& car, const std::vector<CarState>& others);
/// Time until two boxes touch when both keep velocity and heading: separating axes with a relative speed.
/// \return infinity: never
[[nodiscard]] double time_to_contact_s(const Box& a, map::Vec2 velocity_a, const Box& b,
                                       map::Vec2 velocity_b);

}  // namespace s4tp::traffic
