// Who leads us along a path.

#include <gtest/gtest.h>

#include "algo/core/math.hpp"
#include "algo/trajectory/along_path.hpp"
#include "tests/support/candidate_roads.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::trajectory {
namespace {

/// We go straight on at the end of a lane, 15 m before it; the one ahead has begun to turn left there at 4 m/s, 60 degrees
/// over, its centre 4 m into the junction and 1 m left of our line: its tail is 2.5 * sin 60 = 2.2 m right of its centre.
struct Fork {
  LeftTurn road;
  scene::Scene scene;
  Fork() {
    const LaneIndex on = test::add_lane(road.map, {{0.0F, 0.0F}, {60.0F, 0.0F}});
    for (LaneIndex& successor : road.map.lanes[0].successors) {
      if (successor != kNoLaneIndex) continue;
      successor = on;
      break;
    }
    test::add_ego_path(scene, road.map, test::path_of(road.map, {0, on}));
    test::put_ego(scene, test::state_on(road.map, scene.ego_paths[0].path, 35.0F, 8.0F));
    scene::Agent agent;
    agent.track.id = 1;
    agent.track.centre = {4.0F, 1.0F, kPi / 3.0F};
    agent.track.speed_mps = 4.0F;
    agent.track.length_m = 5.0F;
    agent.track.width_m = 1.8F;
    agent.lane = 1;  // the turn
    (void)scene.agents.push(agent);
  }
  [[nodiscard]] int leader() const {
    const scene::EgoPath& path = scene.ego_paths[0];
    return find_leader(scene, path, path.frenet.s_m, Parameters{}).agent;
  }
};

// CAND-028 Who turns off where the lane forks leads us until its tail is out of our way, however far over it is.
TEST(Leader, WhoTurnsOffIsFollowedUntilItIsGone) {
  Fork fork;
  EXPECT_EQ(fork.leader(), 0);
  fork.scene.agents[0].track.centre.y_m = 4.5F;  // 4.5 - 2.2 - 0.45 = 1.85 m, more than 0.9 + 0.2
  EXPECT_EQ(fork.leader(), -1);
}

// CAND-028 The same car across our way, come from elsewhere, is the business of a zone.
TEST(Leader, WhoCrossesIsNot) {
  Fork fork;
  fork.scene.agents[0].lane = kNoLaneIndex;
  EXPECT_EQ(fork.leader(), -1);
}

/// One waits in the middle of its own lane, which ends beside ours and is no part of our way, across it; its front is `short_m` short
/// of our side, 0.9 m right of our line. \return whether it leads us
bool leads_from_its_own_lane(float short_m, float speed_mps) {
  LaneMap map;
  const LaneIndex ours = test::add_lane(map, {{0.0F, 0.0F}, {80.0F, 0.0F}});
  const LaneIndex theirs = test::add_lane(map, {{50.0F, -40.0F}, {50.0F, 0.0F}});
  scene::Scene scene;
  test::add_ego_path(scene, map, test::path_of(map, {ours}));
  test::put_ego(scene, test::state_on(map, scene.ego_paths[0].path, 20.0F, 5.0F));
  (void)test::add_vehicle(scene, map, test::path_of(map, {theirs}), 40.0F - 0.9F - short_m - 2.5F, speed_mps);
  return find_leader(scene, scene.ego_paths[0], 20.0F, Parameters{}).agent == 0;
}

// GUARD-004 Who stands in its own lane is in our way where our box, 0.1 m beside its line, would touch it; 0.15 m off, nearer than
// the 0.2 m of our strip, it is passed. Who moves there is the business of a zone.
TEST(Leader, WhoStandsWhereOurBoxComesLeadsWhateverItsLane) {
  EXPECT_TRUE(leads_from_its_own_lane(-0.3F, 0.0F));
  EXPECT_TRUE(leads_from_its_own_lane(0.05F, 0.0F));
  EXPECT_FALSE(leads_from_its_own_lane(0.15F, 0.0F));
  EXPECT_FALSE(leads_from_its_own_lane(-0.3F, 1.0F));
}

}  // namespace
}  // namespace s4tp::trajectory
