// The safe distance behind a leader, by hand.

#include "algo/occupancy/safe_distance.hpp"

#include <gtest/gtest.h>

namespace s4tp::occupancy {
namespace {

// RSS-001 At 13.9 m/s both: 13.9 * 0.5 + 0.5 * 2 * 0.25 + 14.9^2 / 10 - 13.9^2 / 16 = 6.95 + 0.25 + 22.20
// - 12.08.
TEST(Rss, SafeDistanceByHand) {
  EXPECT_NEAR(safe_distance_m(13.9F, 13.9F, {}), 17.325F, 0.01F);
  EXPECT_NEAR(safe_distance_m(0.0F, 0.0F, {}), 0.35F, 1e-5F);  // 0.25 + 1 / 10
  EXPECT_EQ(safe_distance_m(5.0F, 20.0F, {}), 0.0F);           // it cannot be caught
}

}  // namespace
}  // namespace s4tp::occupancy
