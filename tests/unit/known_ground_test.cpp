// How far around us nobody is missing, as the scene says from lists that left vehicles out.

#include <gtest/gtest.h>

#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp {
namespace {

using test::car;

/// We stand with the box centre at (11.5, 0).
class Lists {
 public:
  void step(const TrackList& tracks, std::uint32_t latency_ms = 0, float speed_mps = 0.0F) {
    now_ms += 100;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(10.0F, 0.0F, 0.0F, speed_mps), tracks, now_ms - latency_ms,
                            &map, {}, scene),
              Status::kOk);
  }
  std::uint32_t now_ms = 5000;
  LaneMap map = test::straight_road(2, 400.0F);
  scene::SceneBuilder builder;
  scene::Scene scene;
};

/// Cars that stand every 10 m from `first_m` ahead of our box centre on.
TrackList queue(int count, float first_m, int first_id = 1) {
  TrackList list;
  for (int i = 0; i < count; ++i)
    (void)list.push(car(static_cast<std::uint8_t>(first_id + i),
                        11.5F + first_m + 10.0F * static_cast<float>(i), 0.0F, 0.0F, 0.0F));
  return list;
}

// CORE-036 A list of three that left two out vouches for 30 m, the furthest of them; one that left nobody out, for
// everything.
TEST(KnownGround, ReachesAsFarAsTheFurthestOfTheList) {
  Lists lists;
  TrackList list = queue(3, 10.0F);
  list.left_out = 2;
  lists.step(list);
  EXPECT_NEAR(lists.scene.known.radius_m, 30.0F, 1e-3F);
  EXPECT_NEAR(lists.scene.known.centre.x_m, 11.5F, 1e-3F);
  EXPECT_EQ(lists.scene.known.left_out, 2);
  lists.step(queue(3, 10.0F));
  EXPECT_EQ(lists.scene.known.left_out, 0);
  EXPECT_EQ(lists.scene.known.radius_m, scene::KnownGround::kEverywhereM);
}

// CORE-036 The last of the list by distance less 2 s of way: 40 m away at 15 m/s counts as 10, before one that stands at 30.
TEST(KnownGround, EndsSoonerForWhoDrives) {
  Lists lists;
  TrackList list = queue(3, 10.0F);
  (void)list.push(car(9, 11.5F + 40.0F, 0.0F, 0.0F, 15.0F));
  list.left_out = 2;
  lists.step(list);
  EXPECT_NEAR(lists.scene.known.radius_m, 30.0F, 1e-3F);
}

// CORE-036 Where all that are listed are as near as that less their way, nothing is known of who stands.
TEST(KnownGround, IsNowhereAmongOnlyFastOnes) {
  Lists lists;
  TrackList list;
  (void)list.push(car(9, 11.5F + 20.0F, 0.0F, 0.0F, 15.0F));
  list.left_out = 1;
  lists.step(list);
  EXPECT_EQ(lists.scene.known.radius_m, 0.0F);
}

// CORE-036 A list of nobody that left somebody out vouches for nothing.
TEST(KnownGround, AnEmptyListThatLeftSomebodyOutKnowsNothing) {
  Lists lists;
  TrackList list;
  list.left_out = 1;
  lists.step(list);
  EXPECT_EQ(lists.scene.known.radius_m, 0.0F);
}

// CORE-036 200 ms after the list, at 10 m/s, what it vouches for lies around where we were then; and it ages until
// the next one.
TEST(KnownGround, LiesWhereWeWereWhenTheListWasMade) {
  Lists lists;
  TrackList list = queue(3, 8.0F);
  list.left_out = 1;
  lists.step(list, 200, 10.0F);
  EXPECT_NEAR(lists.scene.known.centre.x_m, 9.5F, 1e-3F);
  EXPECT_EQ(lists.scene.known.age_ms, 200);
  lists.step(list, 300, 10.0F);
  EXPECT_NEAR(lists.scene.known.centre.x_m, 9.5F, 1e-3F);
  EXPECT_EQ(lists.scene.known.age_ms, 300);
}

// CORE-036 Sixteen are known; then the list lacks the nearest, and names one more behind the last: of these
// seventeen the nearest sixteen are kept, the missing one among them, and known is what is nearer than the one
// without room, 170 m away. That holds for as long as the missing one is kept: 1 s.
TEST(KnownGround, EndsWhereTheSceneHasNoRoom) {
  Lists lists;
  lists.step(queue(kMaxTracks, 10.0F));
  EXPECT_EQ(lists.scene.known.left_out, 0);
  for (int i = 0; i < 10; ++i) {
    lists.step(queue(kMaxTracks, 20.0F, 2));
    ASSERT_EQ(lists.scene.agents.size(), kMaxTracks);
    EXPECT_NE(test::find_agent(lists.scene, 1), nullptr) << i;
    EXPECT_EQ(test::find_agent(lists.scene, kMaxTracks + 1), nullptr) << i;
    EXPECT_EQ(lists.scene.known.left_out, 1) << i;
    EXPECT_NEAR(lists.scene.known.radius_m, 170.0F, 1e-3F);
  }
  for (int i = 0; i < 12; ++i) lists.step(queue(kMaxTracks, 20.0F, 2));
  EXPECT_EQ(test::find_agent(lists.scene, 1), nullptr);
  EXPECT_EQ(lists.scene.known.left_out, 0);
}

// CORE-036 ECU-072 Once it is over it is over: 2^31 ms after somebody had no room that lies in the future.
TEST(KnownGround, DoesNotComeBackWhenTimeWraps) {
  Lists lists;
  lists.step(queue(kMaxTracks, 10.0F));
  lists.step(queue(kMaxTracks, 20.0F, 2));
  ASSERT_EQ(lists.scene.known.left_out, 1);
  for (int i = 0; i < 12; ++i) lists.step(queue(3, 10.0F));
  lists.now_ms += 0x7FFFFFFFU;
  lists.step(queue(3, 10.0F));
  EXPECT_EQ(lists.scene.known.left_out, 0);
}

// CORE-036 The other way round: the furthest is missing, and somebody new stands in between; it is the missing one
// that has no room.
TEST(KnownGround, AMissingVehicleBeyondAllOthersIsLeftOut) {
  Lists lists;
  lists.step(queue(kMaxTracks, 10.0F));
  TrackList list = queue(kMaxTracks - 1, 10.0F);
  ASSERT_TRUE(list.push(car(99, 11.5F, 3.2F, 0.0F, 0.0F)));
  lists.step(list);
  EXPECT_NE(test::find_agent(lists.scene, 99), nullptr);
  EXPECT_EQ(test::find_agent(lists.scene, kMaxTracks), nullptr);
  EXPECT_EQ(lists.scene.known.left_out, 1);
  EXPECT_NEAR(lists.scene.known.radius_m, 160.0F, 1e-3F);
}

}  // namespace
}  // namespace s4tp
