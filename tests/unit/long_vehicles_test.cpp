// What lorries and buses take of our way in bends, beyond what cars do.

#include "algo/trajectory/long_vehicles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/driven_lines.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr float kPi = 3.14159265F;
constexpr float kZoneM = 0.5F;  // steps, and 0.1 m around the boxes

/// We drive along +x, s = x + 100. From the right a lane comes, turns left over our way on 9.2 m, and leads back beside it, 3.2 m to our
/// left. The zone is that of a usual car, as the map has it.
struct LeftTurn {
  LaneMap map;
  scene::LanePath ours;
  scene::LanePath theirs;
  scene::Scene scene;
  Parameters parameters;
  ReferenceLines lines;
  float from_m = 0.0F;  // of their turn, with a usual car in it
  float to_m = 0.0F;

  LeftTurn() {
    const LaneIndex straight = add_lane(map, {{-100.0F, 0.0F}, {100.0F, 0.0F}});
    const LaneIndex before = add_lane(map, {{0.0F, -66.0F}, {0.0F, -6.0F}});
    const LaneIndex turn = add_lane(map, arc({0.0F, -6.0F, 0.5F * kPi}, 9.2F, 0.5F * kPi, 11));
    const LaneIndex after = add_lane(map, {{-9.2F, 3.2F}, {-100.0F, 3.2F}});
    map.lanes[turn].in_junction = true;
    link(map, before, turn);
    link(map, turn, after);
    ours = path_of(map, {straight});
    theirs = path_of(map, {before, turn, after});
    (void)add_ego_path(scene, map, ours);
    scene::ConflictZone zone;
    zone.other_lane = turn;
    zone.priority = Priority::kFirstYields;
    zone.entry_s_m = zone.other_entry_m = 1e3F;
    for (float its_s_m = 55.0F; its_s_m < 80.0F; its_s_m += 0.25F) {
      const Box its{scene::path_point(map, theirs, its_s_m).pose, 5.0F, 1.8F};
      for (float s_m = 80.0F; s_m < 120.0F; s_m += 0.25F) {
        if (separation({{s_m - 100.0F, 0.0F, 0.0F}, 5.0F, 1.8F}, its) > 0.1F) continue;
        zone.entry_s_m = std::min(zone.entry_s_m, s_m);
        zone.exit_s_m = std::max(zone.exit_s_m, s_m);
        zone.other_entry_m = std::min(zone.other_entry_m, its_s_m - 60.0F);
        zone.other_exit_m = std::max(zone.other_exit_m, its_s_m - 60.0F);
      }
    }
    zone.stop_s_m = zone.entry_s_m + 2.5F - 1.0F;
    (void)scene.ego_paths[0].zones.push(zone);
  }

  [[nodiscard]] const scene::ConflictZone& zone() const { return scene.ego_paths[0].zones[0]; }
  scene::Agent& vehicle(float s_m, float length_m) {
    scene::Agent& agent = add_vehicle(scene, map, theirs, s_m, 5.0F);
    agent.track.length_m = length_m;
    return agent;
  }
  /// As of when our rear axle is at `s_m`.
  void look_from(float s_m) {
    const TrajectoryPoint start = state_on(map, ours, s_m, 5.0F);
    put_ego(scene, start);
    (void)build_lines(start, 0.0F, parameters, scene, lines);
  }
};

// CAND-026 A bus of 12 m with its front on the lane, headed away from where its rear came by, is up to 12^2 / (8 * 9.2) = 2 m further in than
// the lane: wherever our box touches it, our box is in the zone, and it is waited for before that. One of a car's length changes nothing.
TEST(LongVehicles, AZoneIsAsLongAsTheyTouchUs) {
  LeftTurn usual;
  const scene::ConflictZone drawn = usual.zone();
  (void)usual.vehicle(30.0F, 5.0F);
  usual.look_from(50.0F);
  EXPECT_FLOAT_EQ(usual.zone().entry_s_m, drawn.entry_s_m);
  EXPECT_FLOAT_EQ(usual.zone().exit_s_m, drawn.exit_s_m);

  LeftTurn turn;
  const scene::Agent& bus = turn.vehicle(30.0F, 12.0F);
  turn.look_from(50.0F);
  EXPECT_LT(turn.zone().entry_s_m, drawn.entry_s_m - 1.0F);
  EXPECT_FLOAT_EQ(turn.zone().stop_s_m, turn.zone().entry_s_m + 1.5F);
  int touches = 0;
  for (float its_s_m = 45.0F; its_s_m < 90.0F; its_s_m += 0.5F) {
    const Point front = position(scene::path_point(turn.map, turn.theirs, its_s_m + 6.0F).pose);
    const Point rear = position(scene::path_point(turn.map, turn.theirs, its_s_m - 6.0F).pose);
    const float heading_rad = std::atan2(front.y_m - rear.y_m, front.x_m - rear.x_m);
    const Box its{
        {front.x_m - 6.0F * std::cos(heading_rad), front.y_m - 6.0F * std::sin(heading_rad), heading_rad},
        12.0F,
        bus.track.width_m};
    for (float s_m = 80.0F; s_m < 120.0F; s_m += 0.5F) {
      if (separation({{s_m - 100.0F, 0.0F, 0.0F}, 5.0F, 1.8F}, its) > 0.0F) continue;
      ++touches;
      EXPECT_GT(s_m, turn.zone().entry_s_m - kZoneM) << its_s_m;
      EXPECT_LT(s_m, turn.zone().exit_s_m + kZoneM) << its_s_m;
    }
  }
  EXPECT_GT(touches, 100);
}

// CAND-026 The zone begins no sooner than we can stop 1 m before it: at 5 m/s 0.35 s and 25 / 12 m further, 4.83 m from our centre. Who is past
// that is bound by the map's zone alone. Nor is it longer for a bus that has gone through.
TEST(LongVehicles, NoZoneBeginsWhereWeCannotStopBeforeIt) {
  const LeftTurn map;
  const float drawn_s_m = map.zone().entry_s_m;
  const auto entry_s_m = [](float centre_s_m, float bus_s_m) {
    LeftTurn turn;
    (void)turn.vehicle(bus_s_m, 12.0F);
    turn.look_from(centre_s_m - rear_axle_to_centre_m(turn.parameters));
    return turn.zone().entry_s_m;
  };
  const float grown_s_m = entry_s_m(50.0F, 30.0F);
  EXPECT_LT(grown_s_m, drawn_s_m - 1.0F);
  EXPECT_NEAR(entry_s_m(grown_s_m - 4.83F + 0.5F, 30.0F), grown_s_m + 0.5F, 0.01F);
  EXPECT_FLOAT_EQ(entry_s_m(drawn_s_m - 4.0F, 30.0F), drawn_s_m);
  EXPECT_FLOAT_EQ(entry_s_m(drawn_s_m + 0.5F, 30.0F), drawn_s_m);
  EXPECT_FLOAT_EQ(entry_s_m(50.0F, 95.0F), drawn_s_m);
}

}  // namespace
}  // namespace s4tp::trajectory
