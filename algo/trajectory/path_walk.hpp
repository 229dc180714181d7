#pragma once
/// Driving an old trajectory's path at another speed.

#include "algo/core/trajectory.hpp"

namespace s4tp::trajectory {

/// Pose and curvature of a trajectory's path by the way driven along it, for growing ways. The path must
/// outlive it.
class PathWalk {
 public:
  explicit PathWalk(const Trajectory& path) : path_(path) {}
  /// Sets pose and curvature of `point`, `way_m` from points[0]; beyond the last point straight on.
  void place(float way_m, TrajectoryPoint& point);

 private:
  const Trajectory& path_;
  int segment_ = 0;
  float passed_m_ = 0.0F;  ///< way from points[0] to points[segment_]
};

}  // namespace s4tp::trajectory
