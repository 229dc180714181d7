#include "algo/core/geometry.hpp"

#include "algo/core/inline.hpp"

namespace s4tp {

Point direction(float heading_rad) {
  const SinCos both = sin_cos(heading_rad);
  return {both.cos, both.sin};
}

Point offset_point(const Pose& pose, float ahead_m, float left_m) {
  const Point ahead = direction(pose.heading_rad);
  return {pose.x_m + (ahead_m * ahead.x_m - left_m * ahead.y_m),
          pose.y_m + (ahead_m * ahead.y_m + left_m * ahead.x_m)};
}

Pose shift_ahead(const Pose& pose, float ahead_m) {
  const Point shifted = offset_point(pose, ahead_m, 0.0F);
  return {shifted.x_m, shifted.y_m, pose.heading_rad};
}

Point to_local(const Pose& frame, Point point) {
  const Point ahead = direction(frame.heading_rad);
  const Point offset = point - position(frame);
  return {dot(ahead, offset), cross(ahead, offset)};
}

bool overlap(const Box& a, const Box& b, float margin_m) {
  return separation(a, b) <= margin_m;
}

float separation(const Box& a, const Box& b) {
  return separation(a, direction(a.centre.heading_rad), b, direction(b.centre.heading_rad));
}

float separation(const Box& a, Point axis_a, const Box& b, Point axis_b) {
  const AxisGaps gaps = axis_gaps(a, axis_a, b, axis_b);
  return max(max(gaps.a_length_m, gaps.a_width_m), max(gaps.b_length_m, gaps.b_width_m));
}

AxisGaps axis_gaps(const Box& a, Point axis_a, const Box& b, Point axis_b) {
  const Point offset = position(b.centre) - position(a.centre);
  // |cos| and |sin| of the angle between the boxes turn the extents of one into the frame of the other.
  const float along = abs(dot(axis_a, axis_b));
  const float across = abs(cross(axis_a, axis_b));
  const float la = 0.5F * a.length_m;
  const float wa = 0.5F * a.width_m;
  const float lb = 0.5F * b.length_m;
  const float wb = 0.5F * b.width_m;
  return {abs(dot(axis_a, offset)) - (la + (lb * along + wb * across)),
          abs(cross(axis_a, offset)) - (wa + (lb * across + wb * along)),
          abs(dot(axis_b, offset)) - (lb + (la * along + wa * across)),
          abs(cross(axis_b, offset)) - (wb + (la * across + wa * along))};
}

}  // namespace s4tp
