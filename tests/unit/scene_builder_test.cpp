#include "algo/scene/scene_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algo/core/math.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp {
namespace {

using test::CrossJunction;

// Three lanes: keep, then left, then right; each 50 m into its lane.
TEST(SceneBuilder, OffersKeepLeftRight) {
  const LaneMap map = test::straight_road(3, 200.0F);
  const scene::Scene scene = test::scene_of(map, test::ego_at(50.0F, 3.0F, 0.0F, 10.0F), {});
  ASSERT_EQ(scene.ego_paths.size(), 3);
  EXPECT_EQ(scene.ego_paths[0].manoeuvre, scene::Manoeuvre::kKeep);
  EXPECT_EQ(scene.ego_paths[0].path.lanes[0].lane, 1);
  EXPECT_NEAR(scene.ego_paths[0].frenet.d_m, -0.2F, 1e-4F);
  EXPECT_EQ(scene.ego_paths[1].manoeuvre, scene::Manoeuvre::kLeft);
  EXPECT_EQ(scene.ego_paths[1].path.lanes[0].lane, 2);
  EXPECT_EQ(scene.ego_paths[2].manoeuvre, scene::Manoeuvre::kRight);
  EXPECT_NEAR(scene.ego_paths[2].frenet.s_m, 50.0F, 1e-3F);
  EXPECT_NEAR(scene.ego_paths[0].goal_s_m, 200.0F, 1e-3F);
}

// CORE-034 Twenty steps of standing are 2 s; at 1 m/s it moves, and the count begins anew. How long it has
// been seen goes on.
TEST(SceneBuilder, CountsHowLongSomebodyStands) {
  const LaneMap map = test::straight_road(1, 200.0F);
  scene::SceneBuilder builder;
  scene::Scene scene;
  std::uint32_t now_ms = 1000;
  const auto step = [&](float speed_mps) {
    now_ms += 100;
    const TrackList tracks = test::track_list({test::car(7, 90.0F, 0.0F, 0.0F, speed_mps)});
    EXPECT_EQ(builder.build(now_ms, test::ego_at(50.0F, 0.0F, 0.0F, 0.0F), tracks, now_ms, &map, Parameters{},
                            scene),
              Status::kOk);
    return static_cast<int>(scene.agents[0].stood_ms);
  };
  EXPECT_EQ(step(0.0F), 0);
  for (int i = 0; i < 19; ++i) (void)step(0.1F);
  EXPECT_EQ(step(0.0F), 2000);
  EXPECT_EQ(step(1.0F), 0);
  EXPECT_EQ(step(0.0F), 100);
  EXPECT_EQ(scene.agents[0].known_ms, 2200);
}

// No map at all, and a map without a lane under us: kNoLane, no paths, but the others are still there.
TEST(SceneBuilder, SaysThatThereIsNoLane) {
  scene::SceneBuilder builder;
  scene::Scene scene;
  const Parameters parameters;
  const TrackList tracks = test::track_list({test::car(1, 20.0F, 0.0F, 0.0F, 5.0F)});
  const EgoState ego = test::ego_at(0.0F, 50.0F, 0.0F, 5.0F);
  EXPECT_EQ(builder.build(100, ego, tracks, 100, nullptr, parameters, scene), Status::kNoLane);
  EXPECT_EQ(scene.ego_paths.size(), 0);
  EXPECT_EQ(scene.agents.size(), 1);
  const LaneMap map = test::straight_road(1, 100.0F);
  EXPECT_EQ(builder.build(200, ego, tracks, 200, &map, parameters, scene), Status::kNoLane);
  EXPECT_EQ(scene.agents[0].paths.size(), 1);
}

// CORE-005 An ego pose that is not a number makes an empty scene and says so.
TEST(SceneBuilder, RefusesAnEgoThatIsNotFinite) {
  scene::SceneBuilder builder;
  scene::Scene scene;
  const Parameters parameters;
  const LaneMap map = test::straight_road(1, 100.0F);
  const EgoState ego = test::ego_at(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F, 5.0F);
  EXPECT_EQ(builder.build(100, ego, TrackList{}, 100, &map, parameters, scene), Status::kInvalidInput);
  EXPECT_EQ(scene.ego_paths.size(), 0);
}

// 20 m before its lane begins, heading for it: the lane goes on straight backwards, s = -20.
TEST(SceneBuilder, TakesTheLaneThatBeginsAhead) {
  const LaneMap map = test::straight_road(1, 100.0F);
  const scene::Scene scene = test::scene_of(map, test::ego_at(-20.0F, 0.2F, 0.0F, 8.0F), {});
  ASSERT_EQ(scene.ego_paths.size(), 1);
  EXPECT_NEAR(scene.ego_paths[0].frenet.s_m, -20.0F, 0.1F);
}

// The middle between lanes is at 1.6 m: drifting left we stay on lane 0 at 1.8 m, are on lane 1 at 2.0 m, and
// drifting back are still on lane 1 at 1.4 m.
TEST(SceneBuilder, EgoLaneHasHysteresis) {
  const LaneMap map = test::straight_road(2, 200.0F);
  scene::SceneBuilder builder;
  scene::Scene scene;
  const Parameters parameters;
  std::uint32_t now_ms = 0;
  const auto lane_at = [&](float y_m) {
    now_ms += 100;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(50.0F, y_m, 0.0F, 10.0F), TrackList{}, now_ms, &map,
                            parameters, scene),
              Status::kOk);
    return scene.ego_paths[0].path.lanes[0].lane;
  };
  EXPECT_EQ(lane_at(0.0F), 0);
  EXPECT_EQ(lane_at(1.8F), 0);
  EXPECT_EQ(lane_at(2.0F), 1);
  EXPECT_EQ(lane_at(1.4F), 1);
  EXPECT_EQ(lane_at(1.2F), 0);
}

// 3.5 m beside the lane it came along (half of 3.2 m and 1.9 m more) the ego still is on its way; one that was never there is not, nor
// is anybody 4.5 m beside it. Drives that a sharp turn had led out of their lane stood there for ever.
TEST(SceneBuilder, WhoHasSwungOutOfItsLaneStillIsOnItsWay) {
  const LaneMap map = test::straight_road(1, 200.0F);
  const Parameters parameters;
  scene::Scene scene;
  const auto at = [&](scene::SceneBuilder& builder, std::uint32_t now_ms, float y_m) {
    return builder.build(now_ms, test::ego_at(50.0F, y_m, 0.0F, 3.0F), TrackList{}, now_ms, &map, parameters,
                         scene);
  };
  scene::SceneBuilder builder;
  EXPECT_EQ(at(builder, 100, 0.0F), Status::kOk);
  EXPECT_EQ(at(builder, 200, 3.5F), Status::kOk);
  EXPECT_EQ(at(builder, 300, 4.5F), Status::kNoLane);
  scene::SceneBuilder fresh;
  EXPECT_EQ(at(fresh, 100, 3.5F), Status::kNoLane);
}

// In a turn sharper than it can be steered the ego turns later than its lane: 90 degrees from the lane it came along it still is on its
// way, at 110 it is not; one that was never on that lane is not from 60 on. Drives through turns of 140 degrees stopped in the junction.
TEST(SceneBuilder, WhoTurnsLaterThanItsLaneStillIsOnItsWay) {
  const LaneMap map = test::straight_road(1, 200.0F);
  const Parameters parameters;
  scene::Scene scene;
  const auto turned_by = [&](scene::SceneBuilder& builder, std::uint32_t now_ms, float degrees) {
    return builder.build(now_ms, test::ego_at(50.0F, 0.0F, degrees * kPi / 180.0F, 3.0F), TrackList{}, now_ms,
                         &map, parameters, scene);
  };
  for (const float side : {-1.0F, 1.0F}) {
    scene::SceneBuilder builder;
    EXPECT_EQ(turned_by(builder, 100, 0.0F), Status::kOk);
    EXPECT_EQ(turned_by(builder, 200, side * 90.0F), Status::kOk);
    EXPECT_EQ(scene.ego_paths[0].path.lanes[0].lane, 0);
    EXPECT_EQ(turned_by(builder, 300, side * 110.0F), Status::kNoLane);
    scene::SceneBuilder fresh;
    EXPECT_EQ(turned_by(fresh, 100, side * 61.0F), Status::kNoLane);
  }
}

// Two lanes leave from where ours ends, 20 m of the same ground: on it we are on the one that needs fewer lane changes, whichever
// the map names first.
TEST(SceneBuilder, WhereLanesPartTakesTheOneThatNeedsFewerChanges) {
  for (const int fewer : {1, 2}) {
    LaneMap map;
    const LaneIndex before = test::add_lane(map, {{-50.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex parting[] = {test::add_lane(map, {{0.0F, 0.0F}, {20.0F, 0.0F}, {60.0F, 3.2F}}),
                                 test::add_lane(map, {{0.0F, 0.0F}, {20.0F, 0.0F}, {60.0F, -3.2F}})};
    for (int i = 0; i < 2; ++i) {
      map.lanes[before].successors[i] = parting[i];
      map.lanes[parting[i]].on_route = true;
      map.lanes[parting[i]].changes_needed = parting[i] == fewer ? -1 : -2;
    }
    map.lanes[before].on_route = true;
    scene::SceneBuilder builder;
    scene::Scene scene;
    std::uint32_t now_ms = 0;
    for (const float x_m : {-5.0F, 2.0F, 10.0F}) {
      now_ms += 500;
      EXPECT_EQ(
          builder.build(now_ms, test::ego_at(x_m, 0.0F, 0.0F, 10.0F), TrackList{}, now_ms, &map, {}, scene),
          Status::kOk);
    }
    EXPECT_EQ(scene.ego_paths[0].path.lanes[0].lane, fewer);
  }
}

// A ramp of 60 m becomes the rightmost of three lanes, which ends after 70 m; the one beside it after 140, and the route's is the third.
// Seen from 20 m along the ramp, the first change is to be made by 60 + 70 = 130 m and the second by 60 + 140 = 200, neither before
// there is a lane beside, at 60. Drives braked as hard as could be where the ramp ended, as nothing was known before, and both
// changes were to be made by the first one's place.
TEST(SceneBuilder, KnowsOnTheRampByWhenEachLaneChangeIsToBeMade) {
  LaneMap map;
  const LaneIndex ramp = test::add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex first = test::add_lane(map, {{0.0F, 0.0F}, {70.0F, 0.0F}});
  const LaneIndex second = test::add_lane(map, {{0.0F, 3.2F}, {140.0F, 3.2F}});
  const LaneIndex third = test::add_lane(map, {{0.0F, 6.4F}, {300.0F, 6.4F}});
  test::link(map, ramp, first);
  test::neighbours(map, first, second);
  test::neighbours(map, second, third);
  map.lanes[first].changes_needed = 2;
  map.lanes[second].changes_needed = 1;
  const scene::Scene scene = test::scene_of(map, test::ego_at(-40.0F, 0.0F, 0.0F, 8.0F), {});
  ASSERT_EQ(scene.ego_paths.size(), 1);
  const scene::EgoPath& path = scene.ego_paths[0];
  EXPECT_EQ(path.changes_needed, 2);
  ASSERT_EQ(path.change_by_s_m.size(), 2);
  EXPECT_NEAR(path.change_by_s_m[0], 130.0F, 0.1F);
  EXPECT_NEAR(path.change_by_s_m[1], 200.0F, 0.1F);
  EXPECT_NEAR(path.change_from_s_m, 60.0F, 0.1F);
  EXPECT_NEAR(path.route_end_s_m, 130.0F, 0.1F);
}

// What is ahead is looked at lane by lane for 150 m: to the end of a junction's lane of 20 m here, where our path's knowledge ends at 170 m,
// on the way to two lane changes that have 100 m of the road beyond. Their last place is 270 m, not 170: drives left the right lane for
// good as soon as such a junction came in sight.
TEST(SceneBuilder, ALaneChangeBeyondWhatIsLookedAtHasItsRoomThere) {
  LaneMap map;
  const LaneIndex road = test::add_lane(map, {{-60.0F, 0.0F}, {90.0F, 0.0F}});
  const LaneIndex junction = test::add_lane(map, {{90.0F, 0.0F}, {110.0F, 0.0F}});
  const LaneIndex beyond = test::add_lane(map, {{110.0F, 0.0F}, {210.0F, 0.0F}});
  test::link(map, road, junction);
  test::link(map, junction, beyond);
  map.lanes[junction].in_junction = true;
  map.lanes[junction].changes_needed = map.lanes[beyond].changes_needed = -2;
  map.lanes[road].route_remaining_m = 270.0F;
  map.lanes[junction].route_remaining_m = 120.0F;
  const scene::Scene scene = test::scene_of(map, test::ego_at(-50.0F, 0.0F, 0.0F, 8.0F), {});
  ASSERT_EQ(scene.ego_paths.size(), 1);
  const scene::EgoPath& path = scene.ego_paths[0];
  ASSERT_EQ(path.path.lanes.size(), 2);
  ASSERT_EQ(path.changes_needed, -2);
  EXPECT_NEAR(path.route_end_s_m, 270.0F, 0.1F);
  for (const float by_s_m : path.change_by_s_m) EXPECT_NEAR(by_s_m, 270.0F, 0.1F);
}

// Lanes side by side, cut by a seam of 1 m that has none beside it: what can be changed before the seam can be begun there, at 0, and
// not only beyond. Drives gave up half a change on passing the seam, as what they had paid little for cost everything from there on.
TEST(SceneBuilder, ASeamWithoutNeighboursDoesNotPutOffALaneChange) {
  LaneMap map;
  const LaneIndex before = test::add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
  const LaneIndex beside_before = test::add_lane(map, {{-60.0F, 3.2F}, {0.0F, 3.2F}});
  const LaneIndex seam = test::add_lane(map, {{0.0F, 0.0F}, {1.0F, 0.0F}});
  const LaneIndex after = test::add_lane(map, {{1.0F, 0.0F}, {101.0F, 0.0F}});
  const LaneIndex beside_after = test::add_lane(map, {{1.0F, 3.2F}, {101.0F, 3.2F}});
  test::link(map, before, seam);
  test::link(map, seam, after);
  test::neighbours(map, before, beside_before);
  test::neighbours(map, after, beside_after);
  for (const LaneIndex lane : {before, seam, after}) map.lanes[lane].changes_needed = 1;
  map.lanes[seam].in_junction = true;
  const scene::Scene scene = test::scene_of(map, test::ego_at(-40.0F, 0.0F, 0.0F, 8.0F), {});
  ASSERT_GE(scene.ego_paths.size(), 1);
  const scene::EgoPath& path = scene.ego_paths[0];
  ASSERT_EQ(path.changes_needed, 1);
  EXPECT_NEAR(path.change_by_s_m[0], 161.0F, 0.1F);
  EXPECT_NEAR(path.change_from_s_m, 0.0F, 0.1F);
}

// The route turns left: our path does too, and its goal and end lie where the route says.
TEST(SceneBuilder, FollowsTheRouteThroughTheJunction) {
  CrossJunction cross = test::cross_junction();
  for (const CrossJunction::Turn turn :
       {CrossJunction::kLeft, CrossJunction::kStraight, CrossJunction::kRight}) {
    test::set_route(cross, CrossJunction::kEast, turn);
    const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F), {});
    ASSERT_EQ(scene.ego_paths.size(), 1);
    const scene::EgoPath& path = scene.ego_paths[0];
    ASSERT_GE(path.path.lanes.size(), 3);
    EXPECT_EQ(path.path.lanes[1].lane, cross.connection[CrossJunction::kEast][turn]);
    EXPECT_NEAR(path.goal_s_m, path.path.length_m, 0.1F);
  }
}

// Two lanes of 100 m into a junction: the lane beside is offered while half of the change is made before, at 10 m/s and
// one second 10 m; from rest up to the end; and to the end whoever has begun it.
TEST(SceneBuilder, NobodySetsOutForALaneBesideJustBeforeAJunction) {
  LaneMap map = test::straight_road(2, 100.0F);
  for (const LaneIndex lane : {LaneIndex{0}, LaneIndex{1}}) {
    const Point end = map.lanes[lane].points[1];
    const LaneIndex across = test::add_lane(map, {end, {end.x_m + 20.0F, end.y_m}});
    map.lanes[across].in_junction = true;
    test::link(map, lane, across);
  }
  const auto paths = [&](float s_m, float left_m, float speed_mps) {
    return test::scene_of(map, test::ego_at(s_m, left_m, 0.0F, speed_mps), {}).ego_paths.size();
  };
  EXPECT_EQ(paths(89.0F, 0.0F, 10.0F), 2);
  EXPECT_EQ(paths(91.0F, 0.0F, 10.0F), 1);
  EXPECT_EQ(paths(91.0F, 1.0F, 10.0F), 2);
  EXPECT_EQ(paths(98.0F, 0.0F, 0.0F), 2);
}

// Turning left from the minor road we must yield to the straight traffic of the main one, and to who comes
// towards us; all zones are in order and we wait half a metre short of the stop line, which is 51.5 m along a
// lane of 52 m: at 51.
TEST(SceneBuilder, FindsTheZonesOfALeftTurn) {
  CrossJunction cross = test::cross_junction();
  test::set_route(cross, CrossJunction::kEast, CrossJunction::kLeft);
  const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F), {});
  const scene::EgoPath& path = scene.ego_paths[0];
  ASSERT_FALSE(path.zones.empty());
  EXPECT_NEAR(path.zones[0].stop_s_m, 51.0F, 1e-3F);
  bool oncoming = false;
  bool from_left = false;
  float last_s_m = 0.0F;
  for (const scene::ConflictZone& zone : path.zones) {
    EXPECT_GE(zone.entry_s_m, last_s_m);
    last_s_m = zone.entry_s_m;
    EXPECT_LE(zone.entry_s_m, zone.exit_s_m);
    EXPECT_LE(zone.stop_s_m, 51.0F + 1e-3F);
    oncoming |= zone.other_lane == cross.connection[CrossJunction::kWest][CrossJunction::kStraight] &&
                zone.priority == Priority::kFirstYields;
    from_left |= zone.other_lane == cross.connection[CrossJunction::kSouth][CrossJunction::kStraight] &&
                 zone.priority == Priority::kFirstYields;
  }
  EXPECT_TRUE(oncoming);
  EXPECT_TRUE(from_left);
}

// The same conflict seen from both sides: whoever yields on the ramp has priority over on the road.
TEST(SceneBuilder, ConvertsThePriorityToOurView) {
  const test::Merge merge = test::merge_road();
  const scene::Scene ramp = test::scene_of(merge.map, test::ego_at(-50.0F, -8.75F, 0.17F, 8.0F), {});
  ASSERT_EQ(ramp.ego_paths[0].zones.size(), 1);
  EXPECT_EQ(ramp.ego_paths[0].zones[0].priority, Priority::kFirstYields);
  EXPECT_EQ(ramp.ego_paths[0].zones[0].other_lane, merge.main_joint);
  const scene::Scene road = test::scene_of(merge.map, test::ego_at(-50.0F, 0.0F, 0.0F, 8.0F), {});
  ASSERT_EQ(road.ego_paths[0].zones.size(), 1);
  EXPECT_EQ(road.ego_paths[0].zones[0].priority, Priority::kFirstHasPriority);
  EXPECT_EQ(road.ego_paths[0].zones[0].other_lane, merge.ramp_joint);
  EXPECT_NEAR(road.ego_paths[0].zones[0].exit_s_m, 126.0F, 0.5F);
}

// A ring of lanes has no end; the path does.
TEST(SceneBuilder, RingRoadEnds) {
  LaneMap map;
  for (int i = 0; i < 4; ++i) {
    const float a = 1.5707963F * static_cast<float>(i);
    test::add_lane(
        map, test::arc({20.0F * std::cos(a), 20.0F * std::sin(a), a + 1.5707963F}, 20.0F, 1.5707963F, 6));
  }
  for (int i = 0; i < 4; ++i) test::link(map, static_cast<LaneIndex>(i), static_cast<LaneIndex>((i + 1) % 4));
  const scene::Scene scene = test::scene_of(map, test::ego_at(20.0F, 1.0F, 1.6F, 5.0F),
                                            {test::car(1, -20.0F, 0.0F, -1.5707963F, 5.0F)});
  ASSERT_EQ(scene.ego_paths.size(), 1);
  EXPECT_EQ(scene.ego_paths[0].path.lanes.size(), 4);
  EXPECT_EQ(scene.agents[0].paths.size(), 1);
}

}  // namespace
}  // namespace s4tp
