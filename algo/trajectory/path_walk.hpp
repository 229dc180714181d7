#pragma once
/// Driving an old trajectory's path at another speed.

#include "algo/core/trajectory.hpp"

namespace s4tp::trajectory {

/// A trajectory by the way driven along it, for growing ways. The trajectory must outlive it.
class PathWalk {
 public:
  explicit PathWalk(const Trajectory& path) : path_(path) {}
  /// Sets `point` to the state `way_m` from points[0]; beyond the last point its path goes on as it is
  /// steered there.
  void place(float way_m, TrajectoryPoint& point);

 private:
  const Trajectory& path_;
  int segment_ = 0;
  float passed_m_ = 0.0F;  ///< way from points[0] to points[segment_]
};

}  // namespace s4tp::trajectory
