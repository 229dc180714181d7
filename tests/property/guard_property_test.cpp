// Whoever drives what the guard passes touches nobody who keeps to the law.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/support/lawful_traffic.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr float kDriveS = 20.0F;

/// Drives one scene of that seed.
bool holds(Priority priority, bool merging, int crossing, bool leader, unsigned seed) {
  Traffic traffic(priority, merging, seed);
  traffic.place(crossing, leader);
  return traffic.run(kDriveS);
}

unsigned any_seed() {
  const auto seed = *rc::gen::noShrink(rc::gen::arbitrary<std::uint32_t>());
  RC_LOG() << "scene of seed " << seed << "\n";
  return seed;
}

// GUARD-010 Behind one who gains 2 m/s^2, brakes with up to 8 and changes its mind at any moment.
TEST(GuardProperty, NobodyAheadIsRunInto) {
  EXPECT_TRUE(rc::check([] { RC_ASSERT(holds(Priority::kFirstHasPriority, false, 0, true, any_seed())); }));
}

// GUARD-010 Across one or two who have priority, and keep to a licence that we used.
TEST(GuardProperty, NobodyWithPriorityIsCutOff) {
  EXPECT_TRUE(rc::check([] {
    const int count = *rc::gen::inRange(1, 3);
    RC_ASSERT(holds(Priority::kFirstYields, false, count, false, any_seed()));
  }));
}

// GUARD-010 The same with one ahead of us, who may stop just behind the zone.
TEST(GuardProperty, NobodyIsCutOffByWhoHasNoRoomBeyond) {
  EXPECT_TRUE(rc::check([] { RC_ASSERT(holds(Priority::kFirstYields, false, 1, true, any_seed())); }));
}

// GUARD-010 Across one or two who owe us the way, and brake for it with 4 m/s^2 after a second if that does.
TEST(GuardProperty, WhoCannotGiveWayIsNotDrivenInto) {
  EXPECT_TRUE(rc::check([] {
    const int count = *rc::gen::inRange(1, 3);
    RC_ASSERT(holds(Priority::kFirstHasPriority, false, count, false, any_seed()));
  }));
}

// GUARD-010 Into the lane of one who has priority there.
TEST(GuardProperty, AMergeTouchesNobody) {
  EXPECT_TRUE(rc::check([] { RC_ASSERT(holds(Priority::kFirstYields, true, 1, false, any_seed())); }));
}

}  // namespace
}  // namespace s4tp
