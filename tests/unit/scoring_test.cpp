// What a motion costs towards the route: a lane change that is due, in time or not.

#include "algo/planner/scoring.hpp"

#include <gtest/gtest.h>

#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp::planner {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

constexpr float kMissed = 480.0F;  // 80 times scoring.lane_route

/// We are at s = 40 m of the right of two lanes; to the goal we have to be in the left one, from `route_end_m` on.
trajectory::ReferenceLine line_of(const LaneMap& map, const scene::LanePath& path) {
  trajectory::ReferenceLine line;
  trajectory::build_reference(map, path, 40.0F, 5.0F, Parameters{}, line);
  return line;
}

struct Road {
  LaneMap map = straight_road(2, 300.0F, 10.0F);
  scene::Scene scene;
  LaneCostToGo cost_to_go;
  Parameters parameters;

  explicit Road(float route_end_m) {
    need_changes(add_ego_path(scene, map, path_of(map, {0})), 1, route_end_m);
    (void)add_ego_path(scene, map, path_of(map, {1}), scene::Manoeuvre::kLeft);
    put_ego(scene, state_on(map, scene.ego_paths[0].path, 40.0F, 5.0F));
    cost_to_go.look(scene, {}, 0.0F, parameters);
  }
  /// Cost of the lane of 3 s at 5 m/s: along our lane, or over to the left one by a quintic of 15 m.
  [[nodiscard]] float lane_cost(bool changes) const {
    return lane_cost(changes ? 1 : 0, changes ? 3.2F : 0.0F);
  }
  /// The same of a motion on `path` that comes `over_m` to the left.
  [[nodiscard]] float lane_cost(int path, float over_m) const { return cost(path, over_m).lane; }
  /// The same of standing there, at 55 m.
  [[nodiscard]] float standing_cost(int path, float over_m) const {
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points) {
      point = state_on(map, scene.ego_paths[0].path, 55.0F, 0.0F);
      point.rear_axle.y_m += over_m;
    }
    int work = 0;
    return score_motion(scene, cost_to_go, path, line_of(map, scene.ego_paths[path].path), 55.0F, trajectory,
                        false, false, parameters, work)
        .lane;
  }
  [[nodiscard]] float progress() const { return cost(0, 0.0F).progress; }

 private:
  [[nodiscard]] CostBreakdown cost(int path, float over_m) const {
    Trajectory trajectory;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      const float way_m = 0.5F * static_cast<float>(i);
      TrajectoryPoint& point = trajectory.points[i];
      point = state_on(map, scene.ego_paths[0].path, 40.0F + way_m, 5.0F);
      const float u = way_m / 15.0F;
      point.rear_axle.y_m += over_m * u * u * u * (10.0F - 15.0F * u + 6.0F * u * u);
    }
    int work = 0;
    return score_motion(scene, cost_to_go, path, line_of(map, scene.ego_paths[path].path), 40.0F, trajectory,
                        false, false, parameters, work);
  }
};

// Our centre is 1.5 m before our rear axle. Where the route ends at 54 m we are 0.27 m from the new lane's centre there (u = 0.83).
// At 48 m it is 2.02 m (u = 0.43), 0.74 m too many: they take 15 * 0.74 / 3.2 = 3.5 m; going 8.5 m past it makes it 5.4 m:
// 5.4 / 15 of a missed route and 4 a metre are 196. At 44 m it is 3.1 m: 8.5 m, 15.5 with 12.5 m past it: all of a missed route, and
// 62.
TEST(Scoring, ALaneChangeThatIsDueCostsByHowLateItIs) {
  EXPECT_LT(Road(54.0F).lane_cost(true), 0.1F * kMissed);
  EXPECT_NEAR(Road(48.0F).lane_cost(true) - Road(54.0F).lane_cost(true), 196.0F, 15.0F);
  EXPECT_NEAR(Road(44.0F).lane_cost(true) - Road(54.0F).lane_cost(true), 542.0F, 30.0F);
}

// Who aims for the lane beside and stays in its own pays for its own, and who is over there for that one. Half way over the line
// between them, 1.6 m from the new lane's centre, (1.6 / 3.2 - 0.4) / 0.6 = 1/6 of the difference is left.
TEST(Scoring, ALaneIsWorthWhatOfTheChangeIsMade) {
  Road road(250.0F);
  road.parameters.scoring.lane_offset = 0.0F;
  const float own = road.lane_cost(0, 0.0F);
  const float there = road.lane_cost(1, 3.2F);
  EXPECT_GT(own, there + 5.0F);
  EXPECT_NEAR(road.lane_cost(1, 0.0F), own, 1e-3F);
  EXPECT_NEAR(road.lane_cost(1, 1.6F), there + (own - there) / 6.0F, 0.01F * own);
}

// At 55 m and 5 m/s our front is at 59 m, and stands 5 m further on. With 15 m left from there a change from rest
// is possible; with 7 m it is late by 8 m: 8 / 15 of a missed route and 4 a metre are 288; who cannot stop before its end
// has missed it.
TEST(Scoring, WhoWaitsForALaneChangeKeepsRoomForIt) {
  const float stands_m = 55.0F + trajectory::rear_axle_to_front_m(Parameters{}) + 5.0F;
  const float with_room = Road(stands_m + 15.0F).lane_cost(false);
  EXPECT_LT(with_room, 0.2F * kMissed);
  EXPECT_NEAR(Road(stands_m + 7.0F).lane_cost(false) - with_room, 288.0F, 10.0F);
  EXPECT_GE(Road(stands_m - 1.0F).lane_cost(false), kMissed);
}

// Our lane ends at 70 m. Driving on in it at 5 m/s leaves 6 m less than a change takes from rest: 9 m late, 324. Half way over at
// 55 m the change goes on: what is left of it takes 1.5 m, and there are 13.5 m. Drives stood for ever, as the half not made yet paid for
// being late in our lane.
TEST(Scoring, AChangeOnItsWayPaysOnlyForItsOwnLateness) {
  Road road(70.0F);
  EXPECT_GT(road.lane_cost(0, 0.0F), 300.0F);
  EXPECT_LT(road.lane_cost(1, 1.6F), 0.1F * kMissed);
}

// From the lane aimed at one more change is due, and both lanes end at 76 m. At 55 m and 5 m/s our front has 17 m: enough for the
// 15 m of that change, driven through, and 3 m short of what waiting for it in our own lane would take, 5 m to a stand and 15:
// 3 / 15 of a missed route and 4 a metre are 108. Where both paid for the stand, drives stood for ever before the first of two changes.
TEST(Scoring, OneChangeAfterTheOtherNeedsNoStandBetween) {
  Road road(76.0F);
  EXPECT_NEAR(road.lane_cost(0, 0.0F) - Road(150.0F).lane_cost(0, 0.0F), 108.0F, 15.0F);
  need_changes(road.scene.ego_paths[1], 1, 76.0F);
  EXPECT_LT(road.lane_cost(1, 3.2F), 0.1F * kMissed);
}

// At rest half way over, 1.6 m of 3.2 are left: another 7.5 m, before the 15 m of the second change: with 20 m that is 2.5 m late, 2.5 / 15
// of a missed route and 4 a metre, and with 23 m in time. Drives stood between two lanes for ever: a stand there paid nothing for
// what driving on could not make up for. Whoever moves makes what is left on the way.
TEST(Scoring, WhoStandsBetweenTwoLanesHasTheRestOfTheChangeToMake) {
  const auto road = [](float room_m) {
    Road made(150.0F);
    need_changes(made.scene.ego_paths[1], 1, 55.0F + 4.0F + room_m);
    return made;
  };
  EXPECT_NEAR(road(20.0F).standing_cost(1, 1.6F) - road(23.0F).standing_cost(1, 1.6F),
              2.5F * (kMissed / 15.0F + 4.0F), 15.0F);
  EXPECT_NEAR(road(23.0F).standing_cost(1, 1.6F), road(24.0F).standing_cost(1, 1.6F), 3.0F);
  EXPECT_NEAR(road(20.0F).lane_cost(1, 1.6F), road(23.0F).lane_cost(1, 1.6F), 6.0F);
}

// Two changes are due, the first by 85 m and the second by 115: at 55 m our front has 26 m to the first place, and 56 to the second. The
// first takes 15 m from a stand 5 m on, both take 35: in time. With both due by 85 m it lacks 9 m: 9 / 15 of a missed route and 4 a
// metre are 324, and the second change that presses is 6 + 6 * 120 / 40 = 24 more.
TEST(Scoring, EachLaneChangeHasItsOwnLastPlace) {
  Road road(85.0F);
  const float one = road.lane_cost(0, 0.0F);
  need_changes(road.scene.ego_paths[0], 2, 85.0F);
  const float both_at_once = road.lane_cost(0, 0.0F);
  road.scene.ego_paths[0].change_by_s_m[1] = 115.0F;
  EXPECT_LT(road.lane_cost(0, 0.0F), one + 0.1F * kMissed);
  EXPECT_NEAR(both_at_once - one, 348.0F, 5.0F);
}

// Without a lane beside there is no choice yet, and nothing to be late for: where lanes to change to begin at 50 m, 20 m before the last
// place, there is room for the change (15 m and 4 to our front), wherever 3 s lead. Drives stood for ever before a short road on which
// they had to change.
TEST(Scoring, NobodyIsLateBeforeThereIsALaneBeside) {
  Road road(70.0F);
  EXPECT_GT(road.lane_cost(0, 0.0F), 300.0F);
  road.scene.ego_paths[0].change_from_s_m = 50.0F;
  EXPECT_LT(road.lane_cost(0, 0.0F), 0.1F * kMissed);
}

// At 5 m/s at the end of 3 s, where 10 are wanted, 25 / (2 * 2) = 6.25 m more are lost until we are as fast: progress is 15 m less that.
// Drives stood for ever where going was worth its first 3 s only.
TEST(Scoring, ProgressCountsUntilWeAreAsFastAsWanted) {
  EXPECT_NEAR(Road(250.0F).progress(), -15.0F + 6.25F, 0.1F);
}

// In a bend of 5 m radius, where 3.5 m/s are wanted, a stand loses what it loses anywhere: 100 / (2 * 2) = 25 m until we drive the limit,
// 10 m/s. Drives stood for ever in the kink at a ramp's end: with 3.5 m/s to make up instead, standing there was worth more than leaving.
TEST(Scoring, AStandInABendIsWorthNoMoreThanElsewhere) {
  LaneMap map = curved_road(5.0F, 1.0F);
  for (LaneIndex lane = 0; lane < 3; ++lane) map.lanes[lane].speed_limit_mps = 10.0F;
  Parameters parameters;
  for (const float s_m : {20.0F, 52.0F}) {
    scene::Scene scene;
    (void)add_ego_path(scene, map, path_of(map, {0, 1, 2}));
    put_ego(scene, state_on(map, scene.ego_paths[0].path, s_m, 0.0F));
    LaneCostToGo cost_to_go;
    cost_to_go.look(scene, {}, 0.0F, parameters);
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points)
      point = state_on(map, scene.ego_paths[0].path, s_m, 0.0F);
    int work = 0;
    EXPECT_NEAR(score_motion(scene, cost_to_go, 0, line_of(map, scene.ego_paths[0].path), s_m, trajectory,
                             false, false, parameters, work)
                    .progress,
                25.0F, 0.1F)
        << s_m;
  }
}

/// A straight road of 250 m whose limit changes at `at_m`.
struct TwoLimits {
  LaneMap map;
  scene::LanePath path;
  Parameters parameters;

  TwoLimits(float at_m, float first_mps, float second_mps) {
    const LaneIndex first = add_lane(map, {{0.0F, 0.0F}, {at_m, 0.0F}});
    const LaneIndex second = add_lane(map, {{at_m, 0.0F}, {250.0F, 0.0F}});
    link(map, first, second);
    map.lanes[first].speed_limit_mps = first_mps;
    map.lanes[second].speed_limit_mps = second_mps;
    path = path_of(map, {first, second});
  }
  /// Of a motion from `start_s_m` on, the ego at its first point.
  [[nodiscard]] CostBreakdown cost(float start_s_m, const Trajectory& trajectory) const {
    scene::Scene scene;
    (void)add_ego_path(scene, map, path);
    put_ego(scene, trajectory.points[0]);
    LaneCostToGo cost_to_go;
    cost_to_go.look(scene, {}, 0.0F, parameters);
    int work = 0;
    return score_motion(scene, cost_to_go, 0, line_of(map, path), start_s_m, trajectory, false, false,
                        parameters, work);
  }
};

// A lane of 5 m/s ends 4 m ahead, and one of 20 m/s begins. Standing before it: 4 m take 2 s at 2 m/s^2, 6 m less than at
// 5 m/s, and from 4 m/s on 16^2 / 4 = 64 m are lost. Driven into it at 5 m/s, as soon as it begins: 15^2 / 4 = 56.25 m. Drives stood for ever
// at the end of slow bends, as in the slow lane there was nothing to lose.
TEST(Scoring, WhoStandsBeforeAFasterLaneLosesWhatItsSpeedCosts) {
  const TwoLimits road(50.0F, 5.0F, 20.0F);
  const auto lost_m = [&](float s_m, float speed_mps) {
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points) point = state_on(road.map, road.path, s_m, 0.0F);
    trajectory.points[kHorizonSteps].speed_mps = speed_mps;
    const float last_step_m = 0.5F * kStepS * speed_mps;
    return last_step_m + road.cost(s_m - last_step_m, trajectory).progress;
  };
  EXPECT_NEAR(lost_m(46.0F, 0.0F), 6.0F + 64.0F, 0.5F);
  EXPECT_NEAR(lost_m(50.1F, 5.0F), 56.25F, 0.5F);
}

// Our lane ends in a road of 5 m/s, 20 m ahead; the one to the left, which we need, in one of 20 m/s. Standing in either costs what the
// way we need loses: over 20 m at 2 m/s^2, to 8.9 m/s, (10 - 4.47) * 4.47 = 24.7 m, and 11.06^2 / 4 = 30.6 m beyond. Drives stood for
// ever in a lane that they were to leave: in the slow road there was nothing to lose.
TEST(Scoring, AStandInALaneToBeLeftCostsWhatOurWayLoses) {
  LaneMap map;
  const LaneIndex right = add_lane(map, {{0.0F, 0.0F}, {60.0F, 0.0F}});
  const LaneIndex left = add_lane(map, {{0.0F, 3.2F}, {60.0F, 3.2F}});
  const LaneIndex slow = add_lane(map, {{60.0F, 0.0F}, {200.0F, 0.0F}});
  const LaneIndex fast = add_lane(map, {{60.0F, 3.2F}, {200.0F, 3.2F}});
  link(map, right, slow);
  link(map, left, fast);
  neighbours(map, right, left);
  for (const LaneIndex lane : {right, left}) map.lanes[lane].speed_limit_mps = 10.0F;
  map.lanes[slow].speed_limit_mps = 5.0F;
  map.lanes[fast].speed_limit_mps = 20.0F;
  scene::Scene scene;
  need_changes(add_ego_path(scene, map, path_of(map, {right, slow})), 1, 60.0F);
  (void)add_ego_path(scene, map, path_of(map, {left, fast}), scene::Manoeuvre::kLeft);
  put_ego(scene, state_on(map, scene.ego_paths[0].path, 40.0F, 0.0F));
  const Parameters parameters;  // it outlives the looking
  LaneCostToGo cost_to_go;
  cost_to_go.look(scene, {}, 0.0F, parameters);
  for (int path = 0; path < 2; ++path) {
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points)
      point = state_on(map, scene.ego_paths[path].path, 40.0F, 0.0F);
    int work = 0;
    EXPECT_NEAR(score_motion(scene, cost_to_go, path, line_of(map, scene.ego_paths[path].path), 40.0F,
                             trajectory, false, false, parameters, work)
                    .progress,
                24.7F + 30.6F, 0.3F)
        << path;
  }
}

// A lane of 5 m/s begins 30 m ahead of a road of 20 m/s, and 2 m/s^2 brake for it: sqrt(25 + 4 * left) may be driven. At 18 m/s each
// sample is charged four times what it is too fast by, and its square: at 9, 18 and 27 m, where 10.4, 8.5 and 6.1 m/s may be driven, then
// 5, that is 3 s * (4 * 68 + 797) / 6. At 5 m/s nothing is too fast. Plans made before the limit was known went on gaining speed towards it.
TEST(Scoring, TooFastForALimitAheadCosts) {
  const TwoLimits road(70.0F, 20.0F, 5.0F);
  const auto speed_cost = [&](float speed_mps) {
    Trajectory trajectory;
    for (int i = 0; i < kTrajectoryPoints; ++i)
      trajectory.points[i] =
          state_on(road.map, road.path, 40.0F + kStepS * static_cast<float>(i) * speed_mps, speed_mps);
    return road.cost(40.0F, trajectory).speed / road.parameters.scoring.speed;
  };
  EXPECT_NEAR(speed_cost(18.0F), 535.0F, 25.0F);
  EXPECT_LT(speed_cost(5.0F), 20.0F);
}

// We stand in our lane behind one that stands: where that leaves 2.5 m to it, nothing asks us on; with 3 m more, something
// does.
TEST(Scoring, NobodyIsAskedIntoTheGapItKeepsAtAStand) {
  float speed_costs[2] = {};
  for (int i = 0; i < 2; ++i) {
    Road road(250.0F);
    const float gap_m = road.parameters.comfort.standstill_gap_m + (i == 0 ? 0.0F : 3.0F);
    const float front_m = 40.0F + trajectory::rear_axle_to_front_m(road.parameters);
    scene::Agent& leader =
        add_vehicle(road.scene, road.map, road.scene.ego_paths[0].path, front_m + gap_m + 2.5F, 0.0F);
    satp::KinematicSet standing;
    (void)standing.agents.push(steady_future(road.map, leader));
    road.cost_to_go.look(road.scene, standing, 0.0F, road.parameters);
    Trajectory trajectory;
    for (TrajectoryPoint& point : trajectory.points)
      point = state_on(road.map, road.scene.ego_paths[0].path, 40.0F, 0.0F);
    int work = 0;
    speed_costs[i] =
        score_motion(road.scene, road.cost_to_go, 0, line_of(road.map, road.scene.ego_paths[0].path), 40.0F,
                     trajectory, false, false, road.parameters, work)
            .speed;
  }
  EXPECT_NEAR(speed_costs[0], 0.0F, 0.05F);
  EXPECT_GT(speed_costs[1], 1.0F);
}

}  // namespace
}  // namespace s4tp::planner
