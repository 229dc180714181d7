// The safe distance behind a leader, at any two speeds.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "algo/occupancy/safe_distance.hpp"

namespace s4tp::occupancy {
namespace {

/// `low` .. `high` in hundredths.
float uniform(int low, int high) {
  return 0.01F * static_cast<float>(*rc::gen::inRange(low, high + 1));
}

// RSS-001 The distance grows with the follower's speed, falls with the leader's, and is never negative.
TEST(RssProperty, SafeDistanceIsMonotone) {
  EXPECT_TRUE(rc::check([] {
    const Parameters parameters;
    const float rear = uniform(0, 6000);
    const float front = uniform(0, 6000);
    const float more = uniform(0, 1000);
    const float distance_m = safe_distance_m(rear, front, parameters);
    RC_ASSERT(distance_m >= 0.0F);
    RC_ASSERT(safe_distance_m(rear + more, front, parameters) >= distance_m);
    RC_ASSERT(safe_distance_m(rear, front + more, parameters) <= distance_m);
  }));
}

}  // namespace
}  // namespace s4tp::occupancy
