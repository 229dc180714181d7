#pragma once
/// A polyline with arc length.

#include <vector>

namespace s4tp::world {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
};

struct PolylinePose {
  Vec2 point;
  double heading_rad = 0.0;  ///< smoothed: vertex headings interpolated along the segment
  double curvature_1pm = 0.0;
};

struct PolylineProjection {
  double s_m = 0.0;
  double d_m = 0.0;  ///< left positive
};

class Polyline {
 public:
  Polyline() = default;
  /// \pre at least two different points
  explicit Polyline(std::vector<Vec2> points);

  [[nodiscard]] double length_m() const;
  [[nodiscard]] PolylinePose at(double s_m) const;  ///< goes on straight beyond both ends
  [[nodiscard]] PolylineProjection project(Vec2 point) const;
  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
  /// At most `count` points that stay within `tolerance_m` of the line where possible; the ends are kept.
  [[nodiscard]] Polyline simplified(int count, double tolerance_m) const;
  [[nodiscard]] Polyline part(double from_m, double to_m) const;

 private:
  std::vector<Vec2> points_;
  std::vector<double> arc_m_;
  std::vector<double> heading_rad_;
};

}  // namespace s4tp::world
