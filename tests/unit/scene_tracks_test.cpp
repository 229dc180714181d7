// How the list of tracks becomes agents with a past.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "algo/scene/scene_builder.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp {
namespace {

/// Feeds one vehicle driving along +x on y = 0 with lists of every cycle.
class Drive {
 public:
  Drive() : map_(test::straight_road(2, 400.0F)) {}

  void step(const std::vector<Track>& tracks, std::uint32_t latency_ms = 0) {
    now_ms += 100;
    EXPECT_EQ(
        builder.build(now_ms, ego, test::track_list(tracks), now_ms - latency_ms, &map_, parameters, scene),
        Status::kOk);
  }
  void step_without_list(std::uint32_t last_list_ms) {
    now_ms += 100;
    EXPECT_EQ(builder.build(now_ms, ego, TrackList{}, last_list_ms, &map_, parameters, scene), Status::kOk);
  }

  EgoState ego = test::ego_at(10.0F, 0.0F, 0.0F, 10.0F);
  std::uint32_t now_ms = 5000;
  scene::SceneBuilder builder;
  scene::Scene scene;
  Parameters parameters;

 private:
  LaneMap map_;
};

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

// CORE-030 Lists that stop coming are refused after 500 ms, and nobody goes: a vehicle at 10 m/s is taken to be 10 m on
// after a second and no further after five, its age counts on. A list that comes then and lacks it says that it is gone.
TEST(SceneBuilder, WithoutListsAllStay) {
  Drive drive;
  drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)});
  const std::uint32_t last_ms = drive.now_ms;
  for (int i = 1; i <= 50; ++i) {
    drive.step_without_list(last_ms);
    EXPECT_EQ(drive.scene.list_refused, i > 5) << i;
    ASSERT_EQ(drive.scene.agents.size(), 1) << i;
    EXPECT_EQ(drive.scene.agents[0].age_ms, 100 * i);
    EXPECT_NEAR(drive.scene.agents[0].coasted_m, static_cast<float>(std::min(i, 10)), 1e-2F);
  }
  drive.step({});
  EXPECT_EQ(drive.scene.agents.size(), 0);
}

// CORE-030 Without lists a vehicle that was missing already stays as well, until we stand, a second at least; without
// standing, a minute at most.
TEST(SceneBuilder, WithoutListsAllStayUntilWeStand) {
  for (const bool stand : {true, false}) {
    Drive drive;
    drive.step({test::car(1, 50.0F, 0.0F, 0.0F, 10.0F)});
    drive.step({});
    const std::uint32_t last_ms = drive.now_ms;
    for (int i = 1; i <= 601; ++i) {
      if (stand && i == 30) drive.ego.speed_mps = 0.0F;
      drive.step_without_list(last_ms);
      ASSERT_EQ(drive.scene.agents.size(), i < (stand ? 30 : 601) ? 1 : 0) << i;
    }
  }
}

// CORE-030 Sixteen who were there before a time without lists take no room from the sixteen who are there after it.
TEST(SceneBuilder, AfterATimeWithoutListsWhoIsThereIsKnown) {
  Drive drive;
  std::vector<Track> before;
  std::vector<Track> after;
  for (int i = 0; i < kMaxTracks; ++i) {
    const float x_m = 30.0F + 8.0F * static_cast<float>(i);
    before.push_back(test::car(i, x_m, 0.0F, 0.0F, 0.0F));
    after.push_back(test::car(100 + i, x_m + 200.0F, 0.0F, 0.0F, 0.0F));
  }
  drive.step(before);
  const std::uint32_t last_ms = drive.now_ms;
  for (int i = 0; i < 20; ++i) drive.step_without_list(last_ms);
  drive.step(after);
  ASSERT_EQ(drive.scene.agents.size(), kMaxTracks);
  for (const scene::Agent& agent : drive.scene.agents) EXPECT_GE(agent.track.id, 100);
  EXPECT_EQ(drive.scene.known.left_out, 0);
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

}  // namespace
}  // namespace s4tp
