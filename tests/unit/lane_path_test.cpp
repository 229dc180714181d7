#include "algo/scene/lane_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/lane_maps.hpp"

namespace s4tp::scene {
namespace {

// 100 m along +x: at s = 40 we are at (40, 0), heading 0, no curvature, with the lane's limit and width.
TEST(LanePath, StraightLaneIsItself) {
  const LaneMap map = test::straight_road(1, 100.0F);
  const PathPoint point = path_point(map, test::path_along(map, {0}), 40.0F);
  EXPECT_FLOAT_EQ(point.pose.x_m, 40.0F);
  EXPECT_FLOAT_EQ(point.pose.y_m, 0.0F);
  EXPECT_FLOAT_EQ(point.pose.heading_rad, 0.0F);
  EXPECT_EQ(point.curvature_1pm, 0.0F);
  EXPECT_FLOAT_EQ(point.speed_limit_mps, test::kLimitMps);
  EXPECT_EQ(point.lane, 0);
}

// Beyond both ends the centre line goes on straight, on the first and last lane.
TEST(LanePath, GoesOnStraightBeyondItsEnds) {
  const LaneMap map = test::curved_road(20.0F, 1.5F);
  const LanePath path = test::path_along(map, {0, 1, 2});
  const PathPoint before = path_point(map, path, -10.0F);
  EXPECT_NEAR(before.pose.x_m, -60.0F, 1e-4F);
  EXPECT_EQ(before.lane, 0);
  const PathPoint end = path_point(map, path, path.length_m);
  const PathPoint beyond = path_point(map, path, path.length_m + 10.0F);
  EXPECT_NEAR(distance(position(end.pose), position(beyond.pose)), 10.0F, 1e-3F);
  EXPECT_NEAR(beyond.pose.heading_rad, 1.5F, 1e-3F);
  EXPECT_EQ(beyond.curvature_1pm, 0.0F);
  EXPECT_EQ(beyond.lane, 2);
}

// A quarter circle of radius 9.6 m in 11 chords: curvature 1/9.6 within 2 % everywhere, and every point
// within 1 cm of the circle (a chord alone would be off by 1.37^2 / (8 * 9.6) = 2.4 cm).
TEST(LanePath, JunctionArcHasTheCurvatureOfItsCircle) {
  const test::CrossJunction cross = test::cross_junction();
  const LaneIndex turn = cross.connection[test::CrossJunction::kEast][test::CrossJunction::kLeft];
  const LanePath path = test::path_along(cross.map, {turn});
  for (float s = 0.0F; s < path.length_m; s += 0.1F) {
    const PathPoint point = path_point(cross.map, path, s);
    EXPECT_NEAR(point.curvature_1pm, 1.0F / 9.6F, 0.02F / 9.6F) << s;
    EXPECT_NEAR(std::hypot(point.pose.x_m + 8.0F, point.pose.y_m - 8.0F), 9.6F, 0.01F) << s;
  }
}

// Straight - arc - straight: where lanes meet, the heading does not jump by more than 1 degree.
TEST(LanePath, LanesJoinSmoothly) {
  for (const float angle : {1.5F, -1.5F, 3.0F}) {
    const LaneMap map = test::curved_road(12.0F, angle);
    const LanePath path = test::path_along(map, {0, 1, 2});
    PathCursor cursor(map, path);
    PathPoint last = cursor.at(-1.0F);
    for (float s = -0.95F; s < path.length_m; s += 0.05F) {
      const PathPoint point = cursor.at(s);
      EXPECT_NEAR(distance(position(last.pose), position(point.pose)), 0.05F, 0.01F) << s;
      const float turn = std::remainder(point.pose.heading_rad - last.pose.heading_rad, 6.2831853F);
      EXPECT_LT(std::fabs(turn), 0.0175F + 0.05F / 12.0F) << s;
      last = point;
    }
  }
}

// Five vertices on a quarter circle, as road editors write junction lanes: chords of 4.2 m, yet within 3 cm.
TEST(LanePath, CoarseArcStaysRound) {
  LaneMap map;
  const LaneIndex lane = test::add_lane(map, test::arc({0.0F, 0.0F, 0.0F}, 10.7F, 1.5708F, 5));
  const LanePath path = test::path_along(map, {lane});
  for (float s = 0.0F; s < path.length_m; s += 0.2F) {
    const PathPoint point = path_point(map, path, s);
    EXPECT_NEAR(std::hypot(point.pose.x_m, point.pose.y_m - 10.7F), 10.7F, 0.03F) << s;
    EXPECT_NEAR(point.curvature_1pm, 1.0F / 10.7F, 0.005F) << s;
  }
}

// 2 m left of the lane at x = 30: s = 30, d = +2; 5 m before its start s = -5.
TEST(LanePath, ProjectsOntoStraightLane) {
  const LaneMap map = test::straight_road(1, 100.0F);
  const LanePath path = test::path_along(map, {0});
  const Frenet left = project(map, path, {30.0F, 2.0F}, 0.0F, -1.0F);
  EXPECT_NEAR(left.s_m, 30.0F, 1e-4F);
  EXPECT_NEAR(left.d_m, 2.0F, 1e-4F);
  const Frenet before = project(map, path, {-5.0F, -1.0F}, 0.0F, -1.0F);
  EXPECT_NEAR(before.s_m, -5.0F, 1e-4F);
  EXPECT_NEAR(before.d_m, -1.0F, 1e-4F);
}

// In a U turn (radius 6 m) the way back lies 12 m beside the way there: the reach around the guess decides.
TEST(LanePath, ReachKeepsTheProjectionOnItsOwnBranch) {
  const LaneMap map = test::curved_road(6.0F, 3.14159F);
  const LanePath path = test::path_along(map, {0, 1, 2});
  const Frenet there = project(map, path, {-20.0F, 7.0F}, 30.0F, 10.0F);
  EXPECT_NEAR(there.s_m, 30.0F, 0.1F);
  EXPECT_NEAR(there.d_m, 7.0F, 0.1F);
  const Frenet nearest = project(map, path, {-20.0F, 7.0F}, 30.0F, -1.0F);
  EXPECT_GT(nearest.s_m, 80.0F);
}

// What project() gives as the centre line at the foot is path_point() there, to the bit: along a curve of 10
// m, 2 m beside it, on all three lanes and beyond both ends.
TEST(LanePath, TheFootIsAPointOfThePath) {
  const LaneMap map = test::curved_road(10.0F, 1.5F);
  const LanePath path = test::path_along(map, {0, 1, 2});
  for (float s_m = -5.0F; s_m < path.length_m + 5.0F; s_m += 0.7F) {
    const Point beside = offset_point(path_point(map, path, s_m).pose, 0.0F, 2.0F);
    PathPoint foot;
    int work = 0;
    const Frenet found = project(map, path, beside, s_m + 1.0F, 5.0F, foot, work);
    const PathPoint there = path_point(map, path, found.s_m);
    EXPECT_EQ(foot.pose.x_m, there.pose.x_m);
    EXPECT_EQ(foot.pose.heading_rad, there.pose.heading_rad);
    EXPECT_EQ(foot.curvature_1pm, there.curvature_1pm);
    EXPECT_EQ(foot.lane, there.lane);
  }
}

// Three lanes of 3.2 m: y = 3.5 belongs to lane 1; against the direction of travel, or 5 m outside, to none.
TEST(LanePath, LocatesByDistanceAndHeading) {
  const LaneMap map = test::straight_road(3, 100.0F);
  EXPECT_EQ(locate(map, {50.0F, 3.5F, 0.1F}, 2.0F), 1);
  EXPECT_EQ(locate(map, {50.0F, 3.5F, 3.1F}, 2.0F), kNoLaneIndex);
  EXPECT_EQ(locate(map, {50.0F, -5.0F, 0.0F}, 2.0F), kNoLaneIndex);
}

// Where a left turn and the way straight on start together, the heading tells them apart.
TEST(LanePath, LocatesByHeadingWhereLanesBranch) {
  const test::CrossJunction cross = test::cross_junction();
  const LaneIndex left = cross.connection[0][test::CrossJunction::kLeft];
  const Pose pose = test::on_lane(cross.map.lanes[left], 6.0F);
  EXPECT_EQ(locate(cross.map, pose, 2.0F), left);
}

// A vertex sent twice (quantization) has no direction of its own and does no harm.
TEST(LanePath, RepeatedVertexIsHarmless) {
  LaneMap map;
  test::add_lane(map, {{0.0F, 0.0F}, {10.0F, 0.0F}, {10.0F, 0.0F}, {20.0F, 0.0F}, {20.0F, 0.0F}});
  const LanePath path = test::path_along(map, {0});
  for (const float s : {-1.0F, 5.0F, 10.0F, 15.0F, 20.0F, 25.0F}) {
    const PathPoint point = path_point(map, path, s);
    EXPECT_FLOAT_EQ(point.pose.x_m, s);
    EXPECT_FLOAT_EQ(point.pose.heading_rad, 0.0F);
  }
}

}  // namespace
}  // namespace s4tp::scene
