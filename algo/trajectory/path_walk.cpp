#include "algo/trajectory/path_walk.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::trajectory {

void PathWalk::place(float way_m, TrajectoryPoint& point) {
  constexpr float kTinyM = 1e-4F;  // shorter pieces are standstill
  float length_m = 0.0F;
  for (; segment_ < kHorizonSteps; ++segment_) {
    length_m =
        distance(position(path_.points[segment_].rear_axle), position(path_.points[segment_ + 1].rear_axle));
    if (length_m > kTinyM && passed_m_ + length_m >= way_m) break;
    passed_m_ = passed_m_ + length_m;
  }
  if (segment_ == kHorizonSteps) {
    const TrajectoryPoint& last = path_.points[kHorizonSteps];
    point.rear_axle = shift_ahead(last.rear_axle, way_m - passed_m_);
    point.curvature_1pm = last.curvature_1pm;
    return;
  }
  const TrajectoryPoint& a = path_.points[segment_];
  const TrajectoryPoint& b = path_.points[segment_ + 1];
  const float t = clamp((way_m - passed_m_) / length_m, 0.0F, 1.0F);
  point.rear_axle.x_m = lerp(a.rear_axle.x_m, b.rear_axle.x_m, t);
  point.rear_axle.y_m = lerp(a.rear_axle.y_m, b.rear_axle.y_m, t);
  point.rear_axle.heading_rad = lerp_angle(a.rear_axle.heading_rad, b.rear_axle.heading_rad, t);
  point.curvature_1pm = lerp(a.curvature_1pm, b.curvature_1pm, t);
}

}  // namespace s4tp::trajectory
