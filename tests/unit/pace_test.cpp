// Motion in closed form, against hand-made numbers and small steps.

#include "algo/occupancy/pace.hpp"

#include <gtest/gtest.h>

namespace s4tp::occupancy {
namespace {

// OCC-001 From 4 m/s with 2 m/s^2 to at most 10 m/s: 3 s and 21 m of gaining, then 10 m/s. After 1 s 6 m/s
// and 5 m, after 5 s 10 m/s and 21 + 20 m.
TEST(Pace, GainsAndThenKeepsItsTopSpeed) {
  const Pace pace{4.0F, 2.0F, 10.0F};
  EXPECT_FLOAT_EQ(speed_after_mps(pace, 0.0F), 4.0F);
  EXPECT_FLOAT_EQ(speed_after_mps(pace, 1.0F), 6.0F);
  EXPECT_FLOAT_EQ(speed_after_mps(pace, 5.0F), 10.0F);
  EXPECT_FLOAT_EQ(way_after_m(pace, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(way_after_m(pace, 1.0F), 5.0F);
  EXPECT_FLOAT_EQ(way_after_m(pace, 5.0F), 41.0F);
}

// OCC-001 At 12 m/s with a top of 10, or with nothing to gain, the speed stays: 24 m in 2 s.
TEST(Pace, WhoIsFasterThanTheTopKeepsItsSpeed) {
  for (const Pace& pace : {Pace{12.0F, 2.0F, 10.0F}, Pace{12.0F, 0.0F, 20.0F}}) {
    EXPECT_FLOAT_EQ(speed_after_mps(pace, 2.0F), 12.0F);
    EXPECT_FLOAT_EQ(way_after_m(pace, 2.0F), 24.0F);
    EXPECT_FLOAT_EQ(time_to_cover_s(pace, 24.0F), 2.0F);
  }
}

// OCC-001 The way covered in a time takes that time: at rest, while gaining, at the end of it, long after.
TEST(Pace, TimeAndWayAreInverse) {
  for (const Pace& pace : {Pace{0.0F, 2.0F, 15.0F}, Pace{4.0F, 2.0F, 10.0F}, Pace{9.0F, 0.5F, 9.0F}}) {
    for (const float time_s : {0.1F, 1.0F, 2.9F, 3.0F, 3.1F, 20.0F})
      EXPECT_NEAR(time_to_cover_s(pace, way_after_m(pace, time_s)), time_s, 1e-4F * time_s + 1e-4F) << time_s;
  }
}

// OCC-001 What is behind is reached at once; who stands and gains nothing reaches nothing.
TEST(Pace, NoWayAndNoMotion) {
  const Pace moving{5.0F, 1.0F, 10.0F};
  EXPECT_EQ(time_to_cover_s(moving, 0.0F), 0.0F);
  EXPECT_EQ(time_to_cover_s(moving, -3.0F), 0.0F);
  EXPECT_EQ(time_to_cover_s(Pace{}, 1.0F), kNeverS);
  EXPECT_EQ(time_to_cover_s(Pace{0.01F, 0.0F, 0.0F}, 1000.0F), kNeverS) << "100,000 s are never";
}

// OCC-005 12 m/s at 6 m/s^2 that build up with 40 m/s^3: after 0.15 s and 1.78 m it is 11.55 m/s, which take 11.12 m. Speeding up
// with 3 m/s^2 before, 0.225 s and 2.71 m, then 11.66 m/s and 11.33 m. Braking so already it is 12 m; from 0.3 m/s it
// stands before the braking is there.
TEST(Pace, BrakingTakesItsTimeToBuildUp) {
  EXPECT_NEAR(braking_way_m(12.0F, 0.0F, 6.0F), 1.78F + 11.12F, 0.01F);
  EXPECT_NEAR(braking_way_m(12.0F, 3.0F, 6.0F), 2.71F + 11.33F, 0.02F);
  EXPECT_FLOAT_EQ(braking_way_m(12.0F, -6.0F, 6.0F), stopping_way_m(12.0F, 6.0F));
  EXPECT_FLOAT_EQ(braking_way_m(12.0F, -7.0F, 6.0F), stopping_way_m(12.0F, 6.0F));
  EXPECT_GT(braking_way_m(0.3F, 0.0F, 6.0F), stopping_way_m(0.3F, 6.0F));
  EXPECT_EQ(braking_way_m(0.0F, 0.0F, 6.0F), 0.0F);
}

// OCC-002 12 m/s at 6 m/s^2: 12 m to a standstill. 9 m of them take at least (12 - sqrt(144 - 108)) / 6 = 1
// s; 12 m are not certain to be covered at all, and 0 m are at once.
TEST(Pace, WhoBrakesHardestIsLatest) {
  EXPECT_FLOAT_EQ(stopping_way_m(12.0F, 6.0F), 12.0F);
  EXPECT_FLOAT_EQ(stopping_way_m(0.0F, 6.0F), 0.0F);
  EXPECT_FLOAT_EQ(latest_time_s(12.0F, 6.0F, 9.0F), 1.0F);
  EXPECT_EQ(latest_time_s(12.0F, 6.0F, 12.0F), kNeverS);
  EXPECT_EQ(latest_time_s(12.0F, 6.0F, 0.0F), 0.0F);
  EXPECT_EQ(latest_time_s(0.0F, 6.0F, 0.1F), kNeverS);
}

}  // namespace
}  // namespace s4tp::occupancy
