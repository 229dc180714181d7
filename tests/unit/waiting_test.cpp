// How long we have stood at a junction: from where it counts, and when it is forgotten.

#include <gtest/gtest.h>

#include "algo/scene/scene_builder.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp {
namespace {

/// Lanes end to end along the x axis, those marked in a junction, and the ego on them.
struct Road {
  LaneMap map;
  scene::SceneBuilder builder;
  scene::Scene scene;
  std::uint32_t now_ms = 1000;

  void add(float from_m, float to_m, bool in_junction) {
    const LaneIndex lane = test::add_lane(map, {{from_m, 0.0F}, {to_m, 0.0F}});
    map.lanes[lane].in_junction = in_junction;
    if (lane > 0) test::link(map, static_cast<LaneIndex>(lane - 1), lane);
  }
  float waited_s(float x_m, float speed_mps, std::uint32_t step_ms = 100) {
    now_ms += step_ms;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(x_m, 0.0F, 0.0F, speed_mps), TrackList{}, now_ms, &map,
                            Parameters{}, scene),
              Status::kOk);
    return scene.waited_s;
  }
};

// CORE-033 20 steps at rest 10 m before a zone are 2 s; driving off keeps them, and a hole of 10 s counts as half
// a second. 60 m before nothing is counted; behind the junction it is forgotten. Who has the way does not matter.
TEST(Waiting, RemembersHowLongWeWaited) {
  Road road;
  road.add(0.0F, 200.0F, false);
  const LaneIndex across = test::add_lane(road.map, {{100.0F, -50.0F}, {100.0F, 50.0F}});
  test::add_conflict(road.map, 0, across, Priority::kFirstYields);
  EXPECT_FLOAT_EQ(road.waited_s(85.0F, 0.0F), 0.0F);
  for (int i = 0; i < 20; ++i) (void)road.waited_s(85.0F, 0.0F);
  EXPECT_FLOAT_EQ(road.scene.waited_s, 2.0F);
  EXPECT_FLOAT_EQ(road.waited_s(86.0F, 4.0F), 2.0F);
  EXPECT_FLOAT_EQ(road.waited_s(95.0F, 8.0F), 2.0F);
  EXPECT_FLOAT_EQ(road.waited_s(95.0F, 0.0F, 10'000), 2.5F);
  EXPECT_FLOAT_EQ(road.waited_s(110.0F, 8.0F), 0.0F);
  EXPECT_FLOAT_EQ(road.waited_s(36.0F, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(road.waited_s(36.0F, 0.0F), 0.0F);
  road.map.conflicts[0].priority = Priority::kFirstHasPriority;
  EXPECT_GT(road.waited_s(85.0F, 0.0F), 0.0F);
}

// CORE-033 Before a junction through which no zone of the map is on our way we wait as well: a bend there may be tighter than we steer.
TEST(Waiting, CountsBeforeAnyJunction) {
  for (const bool junction : {false, true}) {
    Road road;
    road.add(0.0F, 100.0F, false);
    road.add(100.0F, 120.0F, junction);
    for (int i = 0; i < 21; ++i) (void)road.waited_s(85.0F, 0.0F);
    EXPECT_FLOAT_EQ(road.scene.waited_s, junction ? 2.0F : 0.0F);
  }
}

// CORE-033 What was waited at one junction is nothing at the next, 10 m behind it.
TEST(Waiting, EndsWithItsJunction) {
  Road road;
  road.add(0.0F, 100.0F, false);
  road.add(100.0F, 110.0F, true);
  road.add(110.0F, 120.0F, false);
  road.add(120.0F, 130.0F, true);
  for (int i = 0; i < 20; ++i) (void)road.waited_s(90.0F, 0.0F);
  EXPECT_GT(road.waited_s(105.0F, 3.0F), 1.8F);
  EXPECT_FLOAT_EQ(road.waited_s(112.0F, 3.0F), 0.0F);
}

}  // namespace
}  // namespace s4tp
