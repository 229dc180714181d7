// Which ways another vehicle may take, and how likely each is.

#include "algo/scene/agent_paths.hpp"

#include <gtest/gtest.h>

#include "algo/occupancy/lane_reach.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp {
namespace {

using test::CrossJunction;

float sum_of_probabilities(const scene::Agent& agent) {
  float sum = 0.0F;
  for (int i = 0; i < agent.paths.size(); ++i) sum += agent.path_probability[i];
  return sum;
}

// A vehicle before the junction may go three ways; they end in three different lanes.
TEST(AgentPaths, AgentsBranchAtTheJunction) {
  const CrossJunction cross = test::cross_junction();
  const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F),
                                            {test::car(1, 1.6F, -30.0F, 1.5708F, 12.0F)});
  const scene::Agent& agent = scene.agents[0];
  ASSERT_EQ(agent.paths.size(), 3);
  EXPECT_NEAR(sum_of_probabilities(agent), 1.0F, 1e-5F);
  EXPECT_EQ(agent.paths[0].lanes[1].lane, cross.connection[CrossJunction::kNorth][CrossJunction::kStraight]);
  EXPECT_GE(agent.path_probability[0], agent.path_probability[1]);
  EXPECT_NEAR(agent.frenet[0].s_m, 30.0F, 0.01F);
}

// At 13 m/s, 3 m before the junction, nobody turns any more; slow, braking and turning its wheels left it
// does.
TEST(AgentPaths, SpeedAndYawTellWhoTurns) {
  const CrossJunction cross = test::cross_junction();
  const EgoState ego = test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F);
  const scene::Scene fast = test::scene_of(cross.map, ego, {test::car(1, 1.6F, -11.0F, 1.5708F, 13.0F)});
  EXPECT_GT(fast.agents[0].path_probability[0], 0.9F);
  Track turning = test::car(1, 1.6F, -9.0F, 1.65F, 5.0F);
  turning.yaw_rate_radps = 0.3F;
  turning.acceleration_mps2 = -1.5F;
  const scene::Scene slow = test::scene_of(cross.map, ego, {turning});
  EXPECT_EQ(slow.agents[0].paths[0].lanes[1].lane,
            cross.connection[CrossJunction::kNorth][CrossJunction::kLeft]);
}

// On an arc that starts together with the way straight on, both are kept while they are close together.
TEST(AgentPaths, KeepsSiblingWaysInsideTheJunction) {
  const CrossJunction cross = test::cross_junction();
  const LaneIndex left = cross.connection[CrossJunction::kNorth][CrossJunction::kLeft];
  const Pose pose = test::on_lane(cross.map.lanes[left], 3.0F);
  Track track = test::car(1, pose.x_m, pose.y_m, pose.heading_rad, 6.0F);
  track.yaw_rate_radps = 6.0F / 9.6F;
  const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F), {track});
  EXPECT_GE(scene.agents[0].paths.size(), 2);
  EXPECT_EQ(scene.agents[0].paths[0].lanes[0].lane, left);
}

// Lateral speed 15 sin(0.06) = 0.9 m/s at 0.4 m left of the centre: changing to the left lane.
TEST(AgentPaths, SeesALaneChangeUnderWay) {
  const LaneMap map = test::straight_road(2, 300.0F);
  const scene::Scene scene =
      test::scene_of(map, test::ego_at(20.0F, 3.2F, 0.0F, 10.0F),
                     {test::car(1, 50.0F, 0.4F, 0.06F, 15.0F), test::car(2, 80.0F, 0.4F, 0.0F, 15.0F)});
  const scene::Agent* changing = test::find_agent(scene, 1);
  ASSERT_NE(changing, nullptr);
  ASSERT_EQ(changing->paths.size(), 2);
  EXPECT_EQ(changing->paths[0].lanes[0].lane, 1);
  EXPECT_EQ(test::find_agent(scene, 2)->paths.size(), 1);
}

// OCC-003 Two lanes of a junction side by side are no neighbours in the map, yet vehicles change there: at 8.6 sin(0.11) =
// 0.94 m/s one 0.8 m left of its centre is 1.46 m from the other's in a second and 1.74 m from its own, so that it may go on in
// there, and so 0.3 m left at 1.4 m/s (1.5 and 1.7), though the other lane is 2.9 m away yet; 0.4 m left (1.86 and 1.34), or along its
// lane, it may not; nor where both lanes end in one.
TEST(AgentPaths, SeesALaneChangeInsideAJunction) {
  const auto ways = [](float left_m, float heading_rad, bool merging) {
    LaneMap map = test::straight_road(2, 100.0F);
    const LaneIndex after = test::add_lane(map, {{100.0F, 0.0F}, {150.0F, 0.0F}});
    for (int lane = 0; lane < 2; ++lane) {
      map.lanes[lane].in_junction = true;
      map.lanes[lane].left = map.lanes[lane].right = kNoLaneIndex;
      if (merging || lane == 0) test::link(map, static_cast<LaneIndex>(lane), after);
    }
    const scene::Scene scene = test::scene_of(map, test::ego_at(20.0F, 3.2F, 0.0F, 10.0F),
                                              {test::car(1, 50.0F, left_m, heading_rad, 8.6F)});
    occupancy::LaneReach reach;
    reach.measure(map, scene.agents[0]);
    EXPECT_EQ(reach.to_start_m(1) < occupancy::kNoWayM, scene.agents[0].paths.size() > 1);
    return scene.agents[0].paths.size();
  };
  EXPECT_EQ(ways(0.8F, 0.11F, false), 2);
  EXPECT_EQ(ways(0.3F, 0.163F, false), 2);
  EXPECT_EQ(ways(0.4F, 0.11F, false), 1);
  EXPECT_EQ(ways(0.8F, 0.0F, false), 1);
  EXPECT_EQ(ways(0.8F, 0.11F, true), 1);
}

}  // namespace
}  // namespace s4tp
