#include "sim_host/world/map/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace s4tp::map {
namespace {

constexpr double kQuarter = std::numbers::pi / 2.0;

/// 10 m east, then 10 m north.
const Polyline kCorner{{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}}};

/// A quarter circle to the left in 22 chords, as the left turns of our networks.
Polyline quarter_circle(double radius_m) {
  std::vector<Vec2> points;
  for (int i = 0; i <= 22; ++i) {
    const double angle = kQuarter * i / 22;
    points.push_back({radius_m * std::sin(angle), radius_m * (1.0 - std::cos(angle))});
  }
  return Polyline(points);
}

// Beyond the end it goes on straight: 3 m north of (10, 10); before the start 2 m west of (0, 0).
TEST(Polyline, GoesOnStraightBeyondBothEnds) {
  EXPECT_DOUBLE_EQ(kCorner.at(23.0).point.y, 13.0);
  EXPECT_DOUBLE_EQ(kCorner.at(-2.0).point.x, -2.0);
  EXPECT_DOUBLE_EQ(kCorner.at(23.0).heading_rad, kQuarter);
}

// At the corner the heading is half way between east and north, and it gets there evenly: half of that at 5
// m.
TEST(Polyline, TurnsSmoothlyBetweenVertices) {
  EXPECT_NEAR(kCorner.at(10.0).heading_rad, kQuarter / 2.0, 1e-12);
  EXPECT_NEAR(kCorner.at(5.0).heading_rad, kQuarter / 4.0, 1e-12);
}

// In the middle of a circle's arc the curvature is 1 / radius (chords are shorter than arcs by 0.02 %).
TEST(Polyline, KnowsTheCurvatureOfAnArc) {
  EXPECT_NEAR(quarter_circle(10.7).at(8.4).curvature_1pm, 1.0 / 10.7, 1e-4);
}

// 2 m left of the first leg, 3 m right of the second, and 4 m beyond the end 1 m to the left.
TEST(Polyline, ProjectsWithLeftPositive) {
  EXPECT_DOUBLE_EQ(kCorner.project({4.0, 2.0}).s_m, 4.0);
  EXPECT_DOUBLE_EQ(kCorner.project({4.0, 2.0}).d_m, 2.0);
  EXPECT_DOUBLE_EQ(kCorner.project({13.0, 6.0}).d_m, -3.0);
  EXPECT_DOUBLE_EQ(kCorner.project({9.0, 14.0}).s_m, 24.0);
  EXPECT_DOUBLE_EQ(kCorner.project({9.0, 14.0}).d_m, 1.0);
}

// 12 points on a quarter circle of 10.7 m are 11 chords of 8.18 degrees: off by 10.7 (1 - cos 4.09) = 0.027
// m.
TEST(Polyline, ShowsALeftTurnInTwelvePoints) {
  const Polyline arc = quarter_circle(10.7);
  const Polyline few = arc.simplified(12, 0.03);
  EXPECT_LE(few.points().size(), 12U);
  for (const Vec2& point : arc.points()) {
    EXPECT_LE(std::abs(few.project(point).d_m), 0.03);
  }
}

// Four points cannot follow the arc within 0.03 m: the number counts, and what is lost stays small (30
// degrees a chord: 10.7 (1 - cos 15) = 0.36 m, and the best split of 22 chords into 3 is a little worse).
TEST(Polyline, TheNumberOfPointsComesBeforeTheTolerance) {
  const Polyline arc = quarter_circle(10.7);
  const Polyline few = arc.simplified(4, 0.03);
  ASSERT_LE(few.points().size(), 4U);
  for (const Vec2& point : arc.points()) {
    EXPECT_LE(std::abs(few.project(point).d_m), 0.5);
  }
}

// A part starts and ends between vertices: 4 m of the first leg and 6 m of the second.
TEST(Polyline, IsCutAnywhere) {
  const Polyline part = kCorner.part(6.0, 16.0);
  EXPECT_DOUBLE_EQ(part.length_m(), 10.0);
  EXPECT_DOUBLE_EQ(part.points().front().x, 6.0);
  EXPECT_DOUBLE_EQ(part.points().back().y, 6.0);
  EXPECT_EQ(part.points().size(), 3U);
}

// One point, or the same twice, has no direction.
TEST(Polyline, NeedsTwoDifferentPoints) {
  EXPECT_THROW(Polyline({{1.0, 2.0}}), std::invalid_argument);
  EXPECT_THROW(Polyline({{1.0, 2.0}, {1.0, 2.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace s4tp::map
