#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "algo/core/math.hpp"
#include "algo/scene/scene.hpp"
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

/// Feeds one vehicle driving along +x on y = 0 with lists of every cycle.
class Drive {
 public:
  Drive() : map_(test::straight_road(2, 400.0F)) {}

  void step(const std::vector<Track>& tracks, std::uint32_t latency_ms = 0) {
    now_ms += 100;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(10.0F, 0.0F, 0.0F, 0.0F), test::track_list(tracks),
                            now_ms - latency_ms, &map_, parameters, scene),
              Status::kOk);
  }
  void step_without_list(std::uint32_t last_list_ms) {
    now_ms += 100;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(10.0F, 0.0F, 0.0F, 0.0F), TrackList{}, last_list_ms, &map_,
                            parameters, scene),
              Status::kOk);
  }

  std::uint32_t now_ms = 5000;
  scene::SceneBuilder builder;
  scene::Scene scene;
  Parameters parameters;

 private:
  LaneMap map_;
};

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

// CORE-033 20 steps at rest 10 m before a zone are 2 s; driving off keeps them, and a hole of 10 s counts as half
// a second. 60 m before nothing is counted; behind the junction it is forgotten. Who has the way does not matter.
TEST(SceneBuilder, RemembersHowLongWeWaited) {
  LaneMap map = test::straight_road(1, 200.0F);
  const LaneIndex across = test::add_lane(map, {{100.0F, -50.0F}, {100.0F, 50.0F}});
  test::add_conflict(map, 0, across, Priority::kFirstYields);
  scene::SceneBuilder builder;
  scene::Scene scene;
  std::uint32_t now_ms = 1000;
  const auto waited_s = [&](float x_m, float speed_mps, std::uint32_t step_ms = 100) {
    now_ms += step_ms;
    EXPECT_EQ(builder.build(now_ms, test::ego_at(x_m, 0.0F, 0.0F, speed_mps), TrackList{}, now_ms, &map,
                            Parameters{}, scene),
              Status::kOk);
    return scene.waited_s;
  };
  EXPECT_FLOAT_EQ(waited_s(85.0F, 0.0F), 0.0F);
  for (int i = 0; i < 20; ++i) (void)waited_s(85.0F, 0.0F);
  EXPECT_FLOAT_EQ(scene.waited_s, 2.0F);
  EXPECT_FLOAT_EQ(waited_s(86.0F, 4.0F), 2.0F);
  EXPECT_FLOAT_EQ(waited_s(95.0F, 8.0F), 2.0F);
  EXPECT_FLOAT_EQ(waited_s(95.0F, 0.0F, 10'000), 2.5F);
  EXPECT_FLOAT_EQ(waited_s(110.0F, 8.0F), 0.0F);
  EXPECT_FLOAT_EQ(waited_s(36.0F, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(waited_s(36.0F, 0.0F), 0.0F);
  map.conflicts[0].priority = Priority::kFirstHasPriority;
  EXPECT_GT(waited_s(85.0F, 0.0F), 0.0F);
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

// A vehicle before the junction may go three ways; they end in three different lanes.
TEST(SceneBuilder, AgentsBranchAtTheJunction) {
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
TEST(SceneBuilder, SpeedAndYawTellWhoTurns) {
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
TEST(SceneBuilder, KeepsSiblingWaysInsideTheJunction) {
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
TEST(SceneBuilder, SeesALaneChangeUnderWay) {
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

// A list 200 ms old: at 10 m/s the vehicle is 2 m further on.
TEST(SceneBuilder, BringsTracksForward) {
  Drive drive;
  drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)}, 200);
  EXPECT_NEAR(drive.scene.agents[0].track.centre.x_m, 52.0F, 1e-3F);
  EXPECT_EQ(drive.scene.agents[0].age_ms, 200);
}

// Around a bend the way forward is the lane, not the tangent: still on the circle of 20 m.
TEST(SceneBuilder, BringsTracksForwardAlongTheirLane) {
  const LaneMap map = test::curved_road(20.0F, 1.5F);
  scene::SceneBuilder builder;
  scene::Scene scene;
  const Parameters parameters;
  const Pose pose = test::on_lane(map.lanes[1], 4.09F);
  const TrackList tracks = test::track_list({test::car(1, pose.x_m, pose.y_m, pose.heading_rad, 10.0F)});
  ASSERT_EQ(builder.build(1000, test::ego_at(-20.0F, 0.0F, 0.0F, 5.0F), tracks, 600, &map, parameters, scene),
            Status::kOk);
  const Pose& centre = scene.agents[0].track.centre;
  EXPECT_NEAR(std::hypot(centre.x_m, centre.y_m - 20.0F), 20.0F, 0.1F);
  EXPECT_NEAR(distance(position(centre), position(pose)), 4.0F, 0.1F);
}

// CORE-035 Three vehicles, two of one id, in ten lists: all are there in each, nobody has another's history,
// each has an id of its own; the count says two. Once the ids are their own again they have a past again.
TEST(SceneBuilder, KeepsVehiclesThatShareAnId) {
  Drive drive;
  drive.step({test::car(3, 60.0F, 0.0F, 0.0F, 0.0F)});
  for (int i = 0; i < 10; ++i) {
    drive.step({test::car(3, 60.0F, 0.0F, 0.0F, 0.0F), test::car(9, 40.0F, 3.2F, 0.0F, 0.0F),
                test::car(3, -20.0F, 0.0F, 0.0F, 0.0F)});
    ASSERT_EQ(drive.scene.agents.size(), 3) << i;
    EXPECT_EQ(drive.scene.id_clashes, 2);
    std::set<int> ids;
    std::set<int> places_m;
    for (const scene::Agent& agent : drive.scene.agents) {
      ids.insert(agent.track.id);
      places_m.insert(static_cast<int>(std::lround(agent.track.centre.x_m)));
      const bool own = agent.track.id == 9;
      EXPECT_EQ(agent.known_ms, own ? (i + 1) * 100 : 100) << i;
      EXPECT_TRUE(own || agent.history.valid == 1U << (kHistorySamples - 1)) << i;
    }
    EXPECT_EQ(ids.size(), 3U);
    EXPECT_EQ(places_m, (std::set<int>{-20, 40, 60}));
  }
  for (int i = 0; i < 3; ++i) drive.step({test::car(3, 60.0F, 0.0F, 0.0F, 0.0F)});
  EXPECT_EQ(drive.scene.id_clashes, 0);
  EXPECT_EQ(test::find_agent(drive.scene, 3)->known_ms, 300);
}

// CORE-035 Sixteen vehicles, all of one id.
TEST(SceneBuilder, KeepsSixteenOfOneId) {
  Drive drive;
  std::vector<Track> cars;
  for (int i = 0; i < kMaxTracks; ++i)
    cars.push_back(test::car(254, 20.0F + 10.0F * static_cast<float>(i), 0.0F, 0.0F, 0.0F));
  for (int i = 0; i < 40; ++i) {
    drive.step(cars);
    ASSERT_EQ(drive.scene.agents.size(), kMaxTracks);
    ASSERT_EQ(drive.scene.id_clashes, kMaxTracks);
  }
}

// CORE-030 A vehicle that drops out of the lists goes on for a second at its speed, then it is gone.
TEST(SceneBuilder, CoastsThenDrops) {
  Drive drive;
  drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)});
  for (int i = 1; i <= 10; ++i) {
    drive.step({});
    ASSERT_EQ(drive.scene.agents.size(), 1) << i;
    EXPECT_NEAR(drive.scene.agents[0].track.centre.x_m, 50.0F + static_cast<float>(i), 1e-2F);
    EXPECT_NEAR(drive.scene.agents[0].coasted_m, static_cast<float>(i), 1e-2F);
    EXPECT_EQ(drive.scene.agents[0].age_ms, 100 * i);
  }
  drive.step({});
  EXPECT_EQ(drive.scene.agents.size(), 0);
}

// CORE-030 Two steps after it was seen at 50 m and 10 m/s, a vehicle is missing at 52 m: a faster one there under
// another id is its place taken, one 6 m beside is not.
TEST(SceneBuilder, NobodyIsMissingInAnothersPlace) {
  for (const float beside_m : {0.0F, 6.0F}) {
    Drive drive;
    drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)});
    drive.step({});
    drive.step({test::car(2, 52.0F, beside_m, 0.0F, 19.0F)});
    EXPECT_EQ(drive.scene.agents.size(), beside_m > 0.0F ? 2 : 1);
  }
}

// CORE-030 Lists that stop coming are refused after 500 ms; what they told of goes no later than a missing one.
TEST(SceneBuilder, ListsThatStopAreRefused) {
  Drive drive;
  drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)});
  const std::uint32_t last_ms = drive.now_ms;
  for (int i = 1; i <= 11; ++i) {
    drive.step_without_list(last_ms);
    EXPECT_EQ(drive.scene.list_refused, i > 5) << i;
    EXPECT_EQ(drive.scene.agents.size(), i <= 10 ? 1 : 0) << i;
  }
}

// Eleven samples 1 m apart after eleven cycles at 10 m/s; before, the missing ones are masked.
TEST(SceneBuilder, HistoryFillsUpWithAMask) {
  Drive drive;
  for (int i = 0; i < 11; ++i) {
    drive.step({test::car(1, 50.0F + static_cast<float>(i), 0.0F, 0.0F, 10.0F)});
    const scene::History& history = drive.scene.agents[0].history;
    const int valid = (1 << 11) - (1 << (10 - i));
    EXPECT_EQ(history.valid, valid) << i;
  }
  const scene::History& history = drive.scene.agents[0].history;
  for (int i = 0; i < 11; ++i) EXPECT_NEAR(history.samples[i].pose.x_m, 50.0F + static_cast<float>(i), 1e-3F);
  EXPECT_EQ(drive.scene.ego_history.valid, 0x7FF);
}

// Lists that are 40 ms or 160 ms old in turn give the same samples: each is brought to the grid.
TEST(SceneBuilder, HistoryIsRobustAgainstJitter) {
  Drive drive;
  for (int i = 0; i < 11; ++i) {
    const std::uint32_t latency_ms = i % 2 == 0 ? 40 : 100;
    const float behind_m = 0.01F * static_cast<float>(latency_ms);
    drive.step({test::car(1, 50.0F + static_cast<float>(i) - behind_m, 0.0F, 0.0F, 10.0F)}, latency_ms);
  }
  const scene::History& history = drive.scene.agents[0].history;
  EXPECT_EQ(history.valid, 0x7FF);
  for (int i = 0; i < 11; ++i) EXPECT_NEAR(history.samples[i].pose.x_m, 50.0F + static_cast<float>(i), 1e-2F);
}

// The tracker renames a vehicle: one agent, with its past.
TEST(SceneBuilder, SurvivesAnIdSwitch) {
  Drive drive;
  for (int i = 0; i < 5; ++i) drive.step({test::car(1, 50.0F + static_cast<float>(i), 0.0F, 0.0F, 10.0F)});
  drive.step({test::car(7, 55.0F, 0.0F, 0.0F, 10.0F)});
  ASSERT_EQ(drive.scene.agents.size(), 1);
  EXPECT_EQ(drive.scene.agents[0].track.id, 7);
  EXPECT_EQ(drive.scene.agents[0].history.valid, 0x7E0);
}

// An id used again 30 m away is another vehicle: no past.
TEST(SceneBuilder, ReusedIdStartsAFreshPast) {
  Drive drive;
  for (int i = 0; i < 5; ++i) drive.step({test::car(1, 50.0F + static_cast<float>(i), 0.0F, 0.0F, 10.0F)});
  drive.step({test::car(1, 90.0F, 3.2F, 0.0F, 10.0F)});
  ASSERT_EQ(drive.scene.agents.size(), 1);
  EXPECT_EQ(drive.scene.agents[0].history.valid, 0x400);
}

// Seven vehicles: five are watched; the one we follow comes first, one far on the other road last.
TEST(SceneBuilder, WatchesTheMostRelevant) {
  CrossJunction cross = test::cross_junction();
  test::set_route(cross, CrossJunction::kEast, CrossJunction::kLeft);
  std::vector<Track> tracks;
  tracks.push_back(
      test::car(9, 1.6F, 55.0F, 1.5708F, 12.0F));             // leaving northwards, 50 m behind the junction
  tracks.push_back(test::car(1, -20.0F, -1.6F, 0.0F, 8.0F));  // ahead of us
  tracks.push_back(test::car(2, 30.0F, 1.6F, 3.1416F, 10.0F));  // oncoming
  tracks.push_back(test::car(3, -1.6F, 40.0F, -1.5708F, 10.0F));
  tracks.push_back(test::car(4, 1.6F, -30.0F, 1.5708F, 10.0F));
  tracks.push_back(test::car(5, -50.0F, 1.6F, 3.1416F, 10.0F));  // has passed us on the other lane
  tracks.push_back(test::car(6, -55.0F, -1.6F, 0.0F, 8.0F));     // behind us
  const scene::Scene scene = test::scene_of(cross.map, test::ego_at(-40.0F, -1.6F, 0.0F, 8.0F), tracks);
  ASSERT_EQ(scene.agents.size(), 7);
  EXPECT_EQ(scene.watched, kMaxAgents);
  for (int i = 0; i < scene.watched; ++i) EXPECT_NE(scene.agents[i].track.id, 5);
  int last = 0;
  for (int i = 0; i < 7; ++i) {
    if (scene.agents[i].track.id == 5) last = i;
  }
  EXPECT_GE(last, kMaxAgents);
}

// The option `nearest` is plain distance.
TEST(SceneBuilder, CanWatchTheNearest) {
  const LaneMap map = test::straight_road(2, 300.0F);
  scene::SceneBuilder builder;
  builder.relevance = scene::Relevance::kNearest;
  scene::Scene scene;
  const Parameters parameters;
  const TrackList tracks =
      test::track_list({test::car(1, 90.0F, 0.0F, 0.0F, 5.0F), test::car(2, 20.0F, 3.2F, 0.0F, 5.0F)});
  ASSERT_EQ(builder.build(100, test::ego_at(50.0F, 0.0F, 0.0F, 10.0F), tracks, 100, &map, parameters, scene),
            Status::kOk);
  EXPECT_EQ(scene.agents[0].track.id, 2);
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
