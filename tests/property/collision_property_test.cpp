#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "algo/sadrf/overlap.hpp"
#include "algo/trajectory/bicycle.hpp"

namespace s4tp::sadrf {
namespace {

constexpr int kParts = 100;      // of what a future may be off
constexpr float kNear = 0.011F;  // one of them, and rounding

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

/// Every step looked at: the boxes of anybody as far off as it may be, in hundredths of that.
float looked_at_all(const Trajectory& trajectory, const satp::Mode& mode, const Track& track,
                    const Parameters& parameters) {
  float apart_m = 0.0F;
  float likeliest = 0.0F;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const Box own = trajectory::ego_box(trajectory.points[i + 1].rear_axle, parameters);
    const Pose& pose = mode.steps[i];
    if (i == 0) {
      const float gap_m = separation(own, {pose, track.length_m, track.width_m});
      if (gap_m <= 0.0F) apart_m = 0.3F - gap_m;
      continue;
    }
    const Pose& before = mode.steps[i - 1];
    const float off_m = parameters.scoring.timing_error * static_cast<float>(i + 1) *
                        std::hypot(pose.x_m - before.x_m, pose.y_m - before.y_m);
    for (int part = 0; part <= kParts; ++part) {
      const float share = static_cast<float>(part) / kParts;
      // Longer by what it may be off at either end: swept by all it may be off.
      const Box swept = {pose, track.length_m + 2.0F * share * off_m, track.width_m};
      if (separation(own, swept) + apart_m > 0.0F) continue;
      likeliest = std::max(likeliest, 1.0F - share);
      break;
    }
  }
  return likeliest;
}

// The steps and boxes that touch_likelihood() passes over change nothing: two cars within 30 m of each other's
// start, each on a circle of its own; so with a mode whose longest step is not known.
TEST(CollisionProperty, WhatIsPassedOverHitsNobody) {
  EXPECT_TRUE(rc::check([] {
    Parameters parameters;
    parameters.scoring.timing_error = uniform(0, 30);
    Trajectory trajectory;
    satp::Mode mode;
    drive(15.0F, [&](int i, const TrajectoryPoint& point) { trajectory.points[i] = point; });
    drive(15.0F, [&](int i, const TrajectoryPoint& point) {
      if (i > 0) mode.steps[i - 1] = point.rear_axle;
    });
    Track track;
    track.length_m = uniform(200, 1500);
    track.width_m = uniform(60, 260);
    const float all = looked_at_all(trajectory, mode, track, parameters);
    RC_ASSERT(std::abs(touch_likelihood(trajectory, mode, track, parameters) - all) <= kNear);
    satp::measure_steps(mode);
    for (int i = 1; i < kHorizonSteps; ++i) {
      const float step_m =
          std::hypot(mode.steps[i].x_m - mode.steps[i - 1].x_m, mode.steps[i].y_m - mode.steps[i - 1].y_m);
      RC_ASSERT(step_m <= 0.01F * static_cast<float>(mode.longest_step_cm));
    }
    RC_ASSERT(std::abs(touch_likelihood(trajectory, mode, track, parameters) - all) <= kNear);
  }));
}

}  // namespace
}  // namespace s4tp::sadrf
