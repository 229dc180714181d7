#pragma once
/// A straight road of two lanes, and our ways on it: to stay in the right one, or to change to the left one.

#include "tests/support/shared_ground.hpp"

namespace s4tp::test {

/// Along x from `start`, and `left_m` further to the left by the end of its 3 s.
inline Trajectory across(const TrajectoryPoint& start, float acceleration_mps2, float left_m) {
  Trajectory trajectory;
  trajectory.points[0] = start;
  for (int i = 1; i < kTrajectoryPoints; ++i) {
    trajectory.points[i] =
        trajectory::bicycle_step(trajectory.points[i - 1], acceleration_mps2, 0.0F, kStepS);
    trajectory.points[i].rear_axle.y_m =
        start.rear_axle.y_m + left_m * static_cast<float>(i) / static_cast<float>(kHorizonSteps);
  }
  return trajectory;
}

struct LaneChangeRoad {
  LaneMap map = straight_road(2, 400.0F);
  scene::Scene scene;
  Parameters parameters;

  LaneChangeRoad() {
    add_ego_path(scene, map, path_of(map, {0}));
    add_ego_path(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft);
  }
};

}  // namespace s4tp::test
