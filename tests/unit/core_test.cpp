// Geometry, order, trajectory sampling, input ranges and status names: the small things all rooms share.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "algo/core/geometry.hpp"
#include "algo/core/input_ranges.hpp"
#include "algo/core/math.hpp"
#include "algo/core/sort.hpp"
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

namespace {

struct Numbered {
  int key = 0;
  int number = 0;
};

bool smaller(const Numbered& a, const Numbered& b) {
  return a.key < b.key;
}

}  // namespace

// 3 1 2 1 3 becomes 1 1 2 3 3, equals as they came.
TEST(Sort, KeepsEqualsAsTheyCame) {
  BoundedVector<Numbered, 8> list;
  for (const int key : {3, 1, 2, 1, 3}) ASSERT_TRUE(list.push({key, list.size()}));
  sort(list, smaller);
  const Numbered expected[] = {{1, 1}, {1, 3}, {2, 2}, {3, 0}, {3, 4}};
  for (int i = 0; i < list.size(); ++i) {
    EXPECT_EQ(list[i].key, expected[i].key) << i;
    EXPECT_EQ(list[i].number, expected[i].number) << i;
  }
}

// Of 4 2 5 2 1 4, each put in its place, a list of three keeps 1 2 2: the second 2 behind the first, no 4.
TEST(Sort, FullListKeepsTheFirst) {
  BoundedVector<Numbered, 3> list;
  int number = 0;
  for (const int key : {4, 2, 5, 2, 1, 4}) insert(list, {key, number++}, smaller);
  ASSERT_EQ(list.size(), 3);
  const Numbered expected[] = {{1, 4}, {2, 1}, {2, 3}};
  for (int i = 0; i < list.size(); ++i) {
    EXPECT_EQ(list[i].key, expected[i].key) << i;
    EXPECT_EQ(list[i].number, expected[i].number) << i;
  }
}

// ECU-062 A track beyond every range comes out at its ends, a heading of 4 rad as 4 - 2 pi; one within stays as it is.
TEST(InputRanges, ATrackIsBroughtWithin) {
  const Track wild = limited(Track{7, {1.0F, 2.0F, 4.0F}, 61.0F, -12.5F, 1.4F, 0.4F, 3.1F});
  EXPECT_EQ(wild.id, 7);
  EXPECT_NEAR(wild.centre.heading_rad, 4.0F - 2.0F * kPi, 1e-6F);
  EXPECT_EQ(wild.speed_mps, 60.0F);
  EXPECT_EQ(wild.acceleration_mps2, -12.0F);
  EXPECT_EQ(wild.yaw_rate_radps, 1.3F);
  EXPECT_EQ(wild.length_m, 0.5F);
  EXPECT_EQ(wild.width_m, 3.0F);
  const Track tame = limited(Track{7, {1.0F, 2.0F, 3.0F}, 59.0F, -11.5F, 1.2F, 0.6F, 2.9F});
  EXPECT_EQ(tame.centre.heading_rad, 3.0F);
  EXPECT_EQ(tame.speed_mps, 59.0F);
  EXPECT_EQ(tame.acceleration_mps2, -11.5F);
  EXPECT_EQ(tame.yaw_rate_radps, 1.2F);
  EXPECT_EQ(tame.length_m, 0.6F);
  EXPECT_EQ(tame.width_m, 2.9F);
}

// Half a metre per second above what is promised a track is taken, with two it is not; nor is what is no number.
TEST(InputRanges, NoiseAtTheEdgeIsTaken) {
  EXPECT_TRUE(is_taken(60.5F, kTrackSpeedMps));
  EXPECT_FALSE(is_taken(62.0F, kTrackSpeedMps));
  EXPECT_FALSE(is_taken(-0.1F, kTrackSpeedMps));
  EXPECT_FALSE(is_taken(std::nanf(""), kTrackSpeedMps));
}

}  // namespace s4tp
