#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "sim_host/world/map/polyline.hpp"

namespace s4tp::map {
namespace {

/// A line that winds but never turns back: legs of 1 .. 20 m, turns of at most 40 degrees.
Polyline any_road() {
  const int legs = *rc::gen::inRange(1, 30);
  std::vector<Vec2> points{{0.0, 0.0}};
  double heading = 0.01 * *rc::gen::inRange(-314, 314);
  for (int i = 0; i < legs; ++i) {
    const double leg_m = 0.1 * *rc::gen::inRange(10, 200);
    heading += 0.01 * *rc::gen::inRange(-70, 70);
    points.push_back(
        {points.back().x + leg_m * std::cos(heading), points.back().y + leg_m * std::sin(heading)});
  }
  return Polyline(points);
}

// A point of the line is found on the line (perhaps on another leg that passes through it).
TEST(PolylineProperty, ItsOwnPointsAreNoWayOff) {
  EXPECT_TRUE(rc::check([] {
    const Polyline road = any_road();
    const double s = road.length_m() * 0.001 * *rc::gen::inRange(0, 1000);
    const PolylineProjection found = road.project(road.at(s).point);
    RC_ASSERT(std::abs(found.d_m) < 1e-9);
  }));
}

// Cut anywhere, the two parts are as long as the whole and meet.
TEST(PolylineProperty, PartsMakeUpTheWhole) {
  EXPECT_TRUE(rc::check([] {
    const Polyline road = any_road();
    const double cut = road.length_m() * 0.001 * *rc::gen::inRange(1, 999);
    const Polyline head = road.part(0.0, cut);
    const Polyline tail = road.part(cut, road.length_m());
    RC_ASSERT(std::abs(head.length_m() + tail.length_m() - road.length_m()) < 1e-9);
    RC_ASSERT(std::hypot(head.points().back().x - tail.points().front().x,
                         head.points().back().y - tail.points().front().y) < 1e-9);
  }));
}

// Thinned out without a limit to the number, every vertex stays within the tolerance of some chord, both ends
// stay, and no length is gained. With a limit, the limit holds.
TEST(PolylineProperty, ThinningKeepsItsWord) {
  EXPECT_TRUE(rc::check([] {
    const Polyline road = any_road();
    const double tolerance_m = 0.01 * *rc::gen::inRange(0, 100);
    const Polyline few = road.simplified(1000, tolerance_m);
    for (const Vec2& point : road.points()) {
      RC_ASSERT(std::abs(few.project(point).d_m) <= tolerance_m + 1e-9);
    }
    RC_ASSERT(few.points().front().x == road.points().front().x);
    RC_ASSERT(few.points().back().y == road.points().back().y);
    RC_ASSERT(few.length_m() <= road.length_m() + 1e-9);
    const int limit = *rc::gen::inRange(2, 10);
    RC_ASSERT(road.simplified(limit, tolerance_m).points().size() <= static_cast<std::size_t>(limit));
  }));
}

}  // namespace
}  // namespace s4tp::map
