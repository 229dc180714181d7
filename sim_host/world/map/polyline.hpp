#pragma once
/// A polyline with arc length.

#include <cstddef>
#include <vector>

namespace s4tp::map {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
};

struct PolylinePose {
  Vec2 point;
  double heading_rad = 0.0;  ///< smoothed: vertex headings interpolated along the segment; [-pi, pi)
  double curvature_1pm = 0.0;
};

struct PolylineProjection {
  double s_m = 0.0;  ///< < 0 behind the start, > length beyond the end
  double d_m = 0.0;  ///< left positive
};

class Polyline {
 public:
  Polyline() = default;
  /// Points equal to their predecessor are dropped.
  /// \pre at least two different points; \throws std::invalid_argument otherwise
  explicit Polyline(const std::vector<Vec2>& points);

  [[nodiscard]] double length_m() const { return arc_m_.empty() ? 0.0 : arc_m_.back(); }
  [[nodiscard]] PolylinePose at(double s_m) const;  ///< goes on straight beyond both ends
  /// Nearest point of the line and of its straight continuations.
  [[nodiscard]] PolylineProjection project(Vec2 point) const;
  [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
  /// At most `count` (>= 2) of the points that stay within `tolerance_m` of the line where possible, as few
  /// as do; the ends are kept.
  [[nodiscard]] Polyline simplified(int count, double tolerance_m) const;
  /// \pre from_m < to_m; both are limited to the line
  [[nodiscard]] Polyline part(double from_m, double to_m) const;

 private:
  [[nodiscard]] std::size_t segment_at(double s_m) const;

  std::vector<Vec2> points_;
  std::vector<double> arc_m_;        ///< of each point
  std::vector<double> heading_rad_;  ///< of each point, unwrapped: neighbours differ by less than pi
};

/// To [-pi, pi).
[[nodiscard]] double wrap_angle(double angle_rad);

}  // namespace s4tp::map
