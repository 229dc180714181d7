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
    const float beyond_m = way_m - passed_m_;
    const float turn_rad = last.curvature_1pm * beyond_m;
    point = last;
    point.rear_axle.heading_rad = last.rear_axle.heading_rad + 0.5F * turn_rad;
    point.rear_axle = shift_ahead(point.rear_axle, beyond_m);
    point.rear_axle.heading_rad = wrap_angle(last.rear_axle.heading_rad + turn_rad);
    return;
  }
  const TrajectoryPoint& a = path_.points[segment_];
  const TrajectoryPoint& b = path_.points[segment_ + 1];
  const float t = clamp((way_m - passed_m_) / length_m, 0.0F, 1.0F);
  point = interpolate(a, b, t);
}

}  // namespace s4tp::trajectory
