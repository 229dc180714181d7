#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "algo/sadrf/overlap.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::sadrf {
namespace {

/// `low` .. `high` in hundredths.
float uniform(int low, int high) {
  return 0.01F * static_cast<float>(*rc::gen::inRange(low, high + 1));
}

/// Drives from (x, y) with constant speed and curvature.
template <typename Set>
void drive(float reach_m, const Set& set) {
  TrajectoryPoint point;
  point.rear_axle = {uniform(-100, 100) * reach_m, uniform(-100, 100) * reach_m, uniform(-314, 314)};
  point.speed_mps = uniform(0, 2500);
  point.curvature_1pm = uniform(-15, 15);
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    set(i, point);
    point = trajectory::bicycle_step(point, 0.0F, 0.0F, kStepS);
  }
}

/// Every step looked at, box against box.
int looked_at_all(const Trajectory& trajectory, const satp::Mode& mode, const Track& track, float margin_m,
                  const Parameters& parameters) {
  float least_m = margin_m;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const Box own = trajectory::ego_box(trajectory.points[i + 1].rear_axle, parameters);
    const float gap_m = separation(own, {mode.steps[i], track.length_m, track.width_m});
    if (gap_m >= least_m) continue;
    if (i > 0) return i;
    least_m = gap_m > 0.0F ? 0.5F * gap_m : gap_m - 0.3F;
  }
  return -1;
}

// The steps and boxes that first_collision() passes over change nothing: two cars within 30 m of each other's
// start, each on a circle of its own; so with a mode whose longest step is not known.
TEST(CollisionProperty, WhatIsPassedOverHitsNobody) {
  EXPECT_TRUE(rc::check([] {
    const Parameters parameters;
    Trajectory trajectory;
    satp::Mode mode;
    drive(15.0F, [&](int i, const TrajectoryPoint& point) { trajectory.points[i] = point; });
    drive(15.0F, [&](int i, const TrajectoryPoint& point) {
      if (i > 0) mode.steps[i - 1] = point.rear_axle;
    });
    Track track;
    track.length_m = uniform(200, 1500);
    track.width_m = uniform(60, 260);
    const float margin_m = uniform(0, 50);
    const int all = looked_at_all(trajectory, mode, track, margin_m, parameters);
    RC_ASSERT(first_collision(trajectory, mode, track, kHorizonSteps, margin_m, parameters) == all);
    satp::measure_steps(mode);
    for (int i = 1; i < kHorizonSteps; ++i) {
      const float step_m =
          std::hypot(mode.steps[i].x_m - mode.steps[i - 1].x_m, mode.steps[i].y_m - mode.steps[i - 1].y_m);
      RC_ASSERT(step_m <= 0.01F * static_cast<float>(mode.longest_step_cm));
    }
    RC_ASSERT(first_collision(trajectory, mode, track, kHorizonSteps, margin_m, parameters) == all);
  }));
}

}  // namespace
}  // namespace s4tp::sadrf
