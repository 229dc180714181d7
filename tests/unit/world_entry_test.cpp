// How the ego comes along its start lane before anybody else drives it.

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/wire/codec.hpp"
#include "sim_host/world/world.hpp"

namespace s4tp::world {
namespace {

/// A lane that turns left by 10 degrees 16, 22 and 34 m from its start; the ego enters it at 30 m with 10 m/s.
scenario::Scenario bent_lane() {
  constexpr double kTurn_rad[] = {0.0, 0.175, 0.349, 0.524};
  constexpr double kLength_m[] = {16.0, 6.0, 12.0, 180.0};
  std::vector<map::Vec2> points = {{0.0, 0.0}};
  for (int i = 0; i < 4; ++i) {
    points.push_back({points.back().x + kLength_m[i] * std::cos(kTurn_rad[i]),
                      points.back().y + kLength_m[i] * std::sin(kTurn_rad[i])});
  }
  scenario::Scenario scenario;
  map::Lane lane;
  lane.name = "bend_0";
  lane.edge = "bend";
  lane.centre = map::Polyline(points);
  scenario.network.lanes = {lane};
  scenario.mission.edges = {"bend"};
  scenario.mission.start_s_m = 30.0;
  scenario.mission.start_speed_mps = 10.0;
  scenario.mission.goal_s_m = 200.0;
  return scenario;
}

// WORLD-038 The poses turn as the yaw rate says, and the rear axle goes where it points, within what a pose is rounded to: 0.01 m in
// 0.02 s. At entry it is at 28.5 m, 4 m or more from the vertices on either side, and has turned by the 20 degrees behind it.
TEST(WorldEntry, RollsInAlongABend) {
  const scenario::Scenario scenario = bent_lane();
  World world(scenario, {});
  std::vector<wire::Frame> frames;
  wire::Pose before;
  double turned_rad = 0.0;
  for (int tick = 1; tick <= 300; ++tick) {
    frames.clear();
    world.tick(frames);
    wire::Motion motion;
    ASSERT_TRUE(wire::decode(frames[0], motion));
    turned_rad += 0.01 * static_cast<double>(motion.yaw_rate_radps);
    if (tick % 2 != 0) continue;
    wire::Pose pose;
    ASSERT_TRUE(wire::decode(frames[2], pose));
    const double heading_rad = static_cast<double>(pose.heading_rad);
    EXPECT_NEAR(heading_rad, turned_rad, 0.01) << tick;
    if (tick > 2) {
      const double x_m = static_cast<double>(pose.x_m - before.x_m);
      const double y_m = static_cast<double>(pose.y_m - before.y_m);
      EXPECT_LT(std::abs(y_m * std::cos(heading_rad) - x_m * std::sin(heading_rad)) / 0.02, 0.6) << tick;
    }
    before = pose;
  }
  EXPECT_NEAR(turned_rad, 0.349, 0.01);
}

}  // namespace
}  // namespace s4tp::world
