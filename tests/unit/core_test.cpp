// Geometry, trajectory sampling and status names: the small things all rooms share.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "algo/core/geometry.hpp"
#include "algo/core/math.hpp"
#include "algo/core/status.hpp"
#include "algo/core/trajectory.hpp"

namespace s4tp {

// A pose at (1, 2) looking along +y: 3 m ahead is (1, 5), 1 m to its left is (0, 2).
TEST(Geometry, LocalFrameIsAheadAndLeft) {
  const Pose pose = {1.0F, 2.0F, 0.5F * kPi};
  const Point ahead = offset_point(pose, 3.0F, 0.0F);
  EXPECT_NEAR(ahead.x_m, 1.0F, 1e-6F);
  EXPECT_NEAR(ahead.y_m, 5.0F, 1e-6F);
  const Point local = to_local(pose, {0.0F, 2.0F});
  EXPECT_NEAR(local.x_m, 0.0F, 1e-6F);
  EXPECT_NEAR(local.y_m, 1.0F, 1e-6F);
}

// Two 4 m cars in line, centres 6 m apart: 2 m of air between the bumpers.
TEST(Geometry, SeparationInLine) {
  const Box a = {{0.0F, 0.0F, 0.0F}, 4.0F, 2.0F};
  const Box b = {{6.0F, 0.0F, 0.0F}, 4.0F, 2.0F};
  EXPECT_NEAR(separation(a, b), 2.0F, 1e-6F);
  EXPECT_FALSE(overlap(a, b, 1.9F));
  EXPECT_TRUE(overlap(a, b, 2.1F));
}

// A square turned by 45 degrees reaches sqrt(2) m to the side: its corner at 3 - 1.414 m is 0.586 m off the
// side.
TEST(Geometry, SeparationOfATurnedBox) {
  const Box a = {{0.0F, 0.0F, 0.0F}, 4.0F, 2.0F};
  const Box b = {{0.0F, 3.0F, 0.25F * kPi}, 2.0F, 2.0F};
  EXPECT_NEAR(separation(a, b), 2.0F - std::sqrt(2.0F), 1e-5F);
}

// Half way between points 3 and 4 of a plan every quantity is the mean, and the heading crosses 180 degrees.
TEST(Plan, SampleInterpolates) {
  Plan plan;
  plan.start_ms = 1000;
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    plan.trajectory.points[i].rear_axle.x_m = static_cast<float>(i);
    plan.trajectory.points[i].speed_mps = 10.0F + static_cast<float>(i);
    plan.trajectory.points[i].rear_axle.heading_rad = i < 4 ? 3.1F : -3.1F;
  }
  const TrajectoryPoint point = sample(plan, 1350);
  EXPECT_FLOAT_EQ(point.rear_axle.x_m, 3.5F);
  EXPECT_FLOAT_EQ(point.speed_mps, 13.5F);
  EXPECT_NEAR(std::fabs(point.rear_axle.heading_rad), kPi, 1e-5F);
}

// Before its start a plan holds its first point, after its end its last; vehicle time may wrap in between.
TEST(Plan, SampleHoldsTheEnds) {
  Plan plan;
  plan.start_ms = 0xFFFFFF00U;
  for (int i = 0; i < kTrajectoryPoints; ++i) plan.trajectory.points[i].speed_mps = static_cast<float>(i);
  EXPECT_EQ(sample(plan, 0xFFFFFE00U).speed_mps, 0.0F);
  EXPECT_EQ(sample(plan, 0xFFFFFF00U + 1000U).speed_mps, 10.0F);
  EXPECT_EQ(sample(plan, 0xFFFFFF00U + 9000U).speed_mps, 30.0F);
}

// CORE-001 CORE-002 CORE-003 CORE-004 CORE-005 CORE-006 CORE-007 CORE-008: every status has a name of its
// own.
TEST(Status, NamesAreDistinct) {
  std::set<std::string> names;
  for (const Status status :
       {Status::kOk, Status::kNotInitialized, Status::kInvalidParameter, Status::kArithmetic,
        Status::kInvalidInput, Status::kNoLane, Status::kNoSafePlan, Status::kStaleTracks}) {
    names.insert(status_name(status));
  }
  EXPECT_EQ(names.size(), 8U);
  EXPECT_EQ(names.count("unknown"), 0U);
}

}  // namespace s4tp
