// What our way through a bend tighter than we can steer takes of the lanes beside it.

#include "algo/trajectory/tight_bends.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// 60 m straight, a right turn by 120 degrees, and a lane that leads on, beside which one leads back, 3.2 m to the left of it, to where the
/// turn ends. We are 20 m before the turn.
struct Turn {
  LaneMap map;
  scene::Scene scene;
  Parameters parameters;
  ReferenceLines lines;
  LaneIndex back = kNoLaneIndex;

  explicit Turn(float radius_m) {
    const float turned_rad = -2.0944F;
    const LaneIndex before = add_lane(map, {{-60.0F, 0.0F}, {0.0F, 0.0F}});
    const LaneIndex turn = add_lane(map, arc({0.0F, 0.0F, 0.0F}, radius_m, turned_rad, 9));
    map.lanes[turn].in_junction = true;
    const Point end = map.lanes[turn].points[map.lanes[turn].point_count - 1];
    const Point on = 80.0F * Point{std::cos(turned_rad), std::sin(turned_rad)};
    const LaneIndex after = add_lane(map, {end, end + on});
    const Point left = 3.2F * Point{-std::sin(turned_rad), std::cos(turned_rad)};
    back = add_lane(map, {end + left + on, end + left});
    link(map, before, turn);
    link(map, turn, after);
    const scene::LanePath path = path_of(map, {before, turn, after});
    (void)add_ego_path(scene, map, path);
    const TrajectoryPoint start = state_on(map, path, 40.0F, 5.0F);
    put_ego(scene, start);
    scene::ConflictZone zone;  // of the map, with a line to wait at
    zone.entry_s_m = 60.0F;
    zone.exit_s_m = 63.0F;
    zone.stop_s_m = 58.0F;
    zone.other_lane = turn;
    (void)scene.ego_paths[0].zones.push(zone);
    (void)build_lines(start, 0.0F, parameters, scene, lines);
  }
};

// CAND-025 On 3 m the lane turns more tightly than we do: our front comes over into the lane that leads back, at its end, where we are
// behind the turn. It is waited for where the map's own zone is.
TEST(TightBends, WhatOurFrontSwingsIntoIsAZone) {
  const Turn turn(3.0F);
  const scene::EgoPath& path = turn.scene.ego_paths[0];
  ASSERT_EQ(path.zones.size(), 2);
  const scene::ConflictZone& zone = path.zones[0].beside ? path.zones[0] : path.zones[1];
  EXPECT_TRUE(zone.beside);
  EXPECT_EQ(zone.other_lane, turn.back);
  EXPECT_EQ(zone.priority, Priority::kFirstYields);
  EXPECT_FLOAT_EQ(zone.stop_s_m, 58.0F);
  const float turn_end_s_m = 60.0F + 3.0F * 2.0944F;
  EXPECT_GT(zone.entry_s_m, 58.0F);
  EXPECT_LT(zone.entry_s_m, turn_end_s_m + 3.0F);
  EXPECT_GT(zone.other_exit_m, 77.0F);
  // Everything our box comes near to is in it.
  for (float s_m = 40.0F; s_m < 85.0F; s_m += 0.5F) {
    const Box ours = ego_box(reference_at(turn.lines[0], s_m).pose, turn.parameters);
    for (float other_m = 60.0F; other_m < 77.5F; other_m += 0.5F) {
      const Lane& lane = turn.map.lanes[turn.back];
      const Point along = (1.0F / lane.length_m) * (lane.points[1] - lane.points[0]);
      const Point at = lane.points[0] + other_m * along;
      const Box other{{at.x_m, at.y_m, std::atan2(along.y_m, along.x_m)}, 5.0F, 1.8F};
      if (separation(ours, other) > 0.0F) continue;
      const float centre_s_m = s_m + rear_axle_to_centre_m(turn.parameters);
      EXPECT_TRUE(centre_s_m > zone.entry_s_m && centre_s_m < zone.exit_s_m) << s_m;
      EXPECT_TRUE(other_m > zone.other_entry_m && other_m < zone.other_exit_m) << other_m;
    }
  }
}

// CAND-025 Where 24 lanes lie across such a turn, as on networks whose edges overlap, looking at them takes less than a quarter of the
// 23,000 units that candidates have: a drive stood for ever where three paths left none.
TEST(TightBends, ManyLanesLeaveWorkForCandidates) {
  Turn turn(3.0F);
  for (int k = 0; k < 24; ++k) {
    const float y_m = 1.0F * static_cast<float>(k) - 14.0F;
    (void)add_lane(turn.map, {{-30.0F, y_m}, {30.0F, y_m}});
  }
  EXPECT_LT(add_zones_beside(turn.scene, turn.parameters, turn.scene.ego_paths[0]), 23'000 / 4);
}

// CAND-025 A turn that we can steer needs nothing of the lanes beside it.
TEST(TightBends, AWideTurnNeedsNoMoreThanItsLane) {
  const Turn turn(6.5F);
  EXPECT_FALSE(turn.lines[0].tight);
  EXPECT_EQ(turn.scene.ego_paths[0].zones.size(), 1);
}

}  // namespace
}  // namespace s4tp::trajectory
