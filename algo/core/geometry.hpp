#pragma once
/// Points, poses and boxes in the plane. Frame: ISO 8855, x forward, y left, angles in [-pi, pi).

namespace s4tp {

struct Point {
  float x_m = 0.0F;
  float y_m = 0.0F;
};

struct Pose {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float heading_rad = 0.0F;
};

/// Oriented rectangle, by its centre.
struct Box {
  Pose centre;
  float length_m = 0.0F;
  float width_m = 0.0F;
};

[[nodiscard]] Point operator+(Point a, Point b);
[[nodiscard]] Point operator-(Point a, Point b);
[[nodiscard]] Point operator*(float k, Point a);
[[nodiscard]] float dot(Point a, Point b);
[[nodiscard]] float cross(Point a, Point b);  ///< z of the cross product: positive when b is left of a
[[nodiscard]] float norm(Point a);
[[nodiscard]] float distance(Point a, Point b);
[[nodiscard]] Point position(const Pose& pose);
[[nodiscard]] Point direction(float heading_rad);  ///< unit vector
/// The point `ahead_m` in front and `left_m` to the left of the pose, in the frame of the pose's parent.
[[nodiscard]] Point offset_point(const Pose& pose, float ahead_m, float left_m);
/// The pose shifted along its own heading (rear axle to box centre and back).
[[nodiscard]] Pose shift_ahead(const Pose& pose, float ahead_m);
/// `point` seen from `frame`: x ahead, y left.
[[nodiscard]] Point to_local(const Pose& frame, Point point);

/// Separating-axis test of two oriented boxes. \return true when no axis shows a gap larger than `margin_m`,
/// as if one of them were grown by it on every side
[[nodiscard]] bool overlap(const Box& a, const Box& b, float margin_m);
/// What two boxes are apart along each axis that may separate them [m]: <= 0 on all four where they overlap.
struct AxisGaps {
  float a_length_m;
  float a_width_m;
  float b_length_m;
  float b_width_m;
};
/// \param axis_a, axis_b  unit vectors of the boxes' headings
[[nodiscard]] AxisGaps axis_gaps(const Box& a, Point axis_a, const Box& b, Point axis_b);
/// Lower bound of the distance between two boxes, by their separating axes [m]; <= 0 when they overlap.
[[nodiscard]] float separation(const Box& a, const Box& b);
/// The same, for who knows the unit vectors of their headings already.
[[nodiscard]] float separation(const Box& a, Point axis_a, const Box& b, Point axis_b);

}  // namespace s4tp
