#include "sim_host/world/traffic/box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace s4tp::traffic {
namespace {

Box box(double x, double y, double heading = 0.0) {
  return {{x, y}, heading, 5.0, 1.8};
}

// Nose to tail 5 m apart at the centres they touch; 1 cm more and they do not.
TEST(Box, OverlapsFromNoseToTail) {
  EXPECT_TRUE(overlap(box(0.0, 0.0), box(4.99, 0.0)));
  EXPECT_FALSE(overlap(box(0.0, 0.0), box(5.01, 0.0)));
}

// Crossing at a right angle they touch while |dx| < 2.5 + 0.9 = 3.4 m; the boxes' circles alone would say 5.3
// m.
TEST(Box, OverlapsAcross) {
  EXPECT_TRUE(overlap(box(0.0, 0.0), box(3.39, 0.0, std::numbers::pi / 2)));
  EXPECT_FALSE(overlap(box(0.0, 0.0), box(3.41, 0.0, std::numbers::pi / 2)));
}

// Side by side at 3.2 m: 3.2 - 1.8 = 1.4 m; diagonally 3 m and 4 m between corners: 5 m.
TEST(Box, Distance) {
  EXPECT_NEAR(distance_m(box(0.0, 0.0), box(0.0, 3.2)), 1.4, 1e-12);
  EXPECT_NEAR(distance_m(box(0.0, 0.0), box(8.0, 5.8)), 5.0, 1e-12);
  EXPECT_EQ(distance_m(box(0.0, 0.0), box(1.0, 0.0)), 0.0);
}

// 10 m of gap closed at 4 m/s: 2.5 s; moving apart or passing beside: never.
TEST(Box, TimeToContact) {
  EXPECT_NEAR(time_to_contact_s(box(0.0, 0.0), {10.0, 0.0}, box(15.0, 0.0), {6.0, 0.0}), 2.5, 1e-12);
  EXPECT_TRUE(std::isinf(time_to_contact_s(box(0.0, 0.0), {6.0, 0.0}, box(15.0, 0.0), {10.0, 0.0})));
  EXPECT_TRUE(std::isinf(time_to_contact_s(box(0.0, 0.0), {10.0, 0.0}, box(15.0, 3.2), {6.0, 0.0})));
}

// A sight line through the middle of a car is blocked, one beside it is not.
TEST(Box, CrossesALine) {
  EXPECT_TRUE(crosses(box(10.0, 0.0), {0.0, 0.0}, {20.0, 0.0}));
  EXPECT_FALSE(crosses(box(10.0, 0.0), {0.0, 2.0}, {20.0, 2.0}));
}

// Angles come out in [-pi, pi): 3 pi is -pi.
TEST(Box, WrapsAngles) {
  EXPECT_NEAR(map::wrap_angle(3.0 * std::numbers::pi), -std::numbers::pi, 1e-12);
  EXPECT_NEAR(map::wrap_angle(-0.1), -0.1, 1e-12);
}

}  // namespace
}  // namespace s4tp::traffic
