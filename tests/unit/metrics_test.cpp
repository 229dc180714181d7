// Metrics from constructed recordings: the arithmetic of the competition's evaluator and of our own.

#include "sim_host/metrics/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace s4tp::metrics {
namespace {

using traffic::CarState;
using traffic::Ending;
using traffic::Recording;
using traffic::Snapshot;

/// One lane of 2 km along y = 0, on which all of these drives go.
const scenario::Scenario& straight() {
  static const scenario::Scenario scenario = [] {
    scenario::Scenario road;
    road.network.lanes.resize(1);
    road.network.lanes[0].edge = "road";
    road.network.lanes[0].centre = map::Polyline({{-1000.0, 0.0}, {1000.0, 0.0}});
    road.mission.edges = {"road"};
    road.mission.goal_s_m = 2000.0;
    return road;
  }();
  return scenario;
}

EpisodeMetrics evaluate(const Recording& recording) {
  return metrics::evaluate(recording, straight());
}

CarState car_at(double x, double speed_mps) {
  CarState car;
  car.centre = {x, 0.0};
  car.speed_mps = speed_mps;
  car.lane = 0;
  return car;
}

/// `count` snapshots from time 0 along +x at constant speed.
Recording cruise(int count, double speed_mps) {
  Recording recording;
  recording.ending = Ending::kGoal;
  for (int i = 0; i < count; ++i) {
    Snapshot snapshot;
    snapshot.time_s = 0.1 * i;
    snapshot.ego = car_at(speed_mps * snapshot.time_s, speed_mps);
    recording.snapshots.push_back(snapshot);
  }
  return recording;
}

// 51 states are 50 steps, as the state at take-over is none: to the goal they cost 50; a crash costs 800 plus
// the way still to go (12 m).
TEST(Comp1, TimeIsStepsPlusDistance) {
  Recording recording = cruise(51, 10.0);
  EXPECT_DOUBLE_EQ(evaluate(recording).comp1.time(), 50.0);
  recording.ending = Ending::kCollision;
  recording.goal_distance_m = 12.0;
  EXPECT_DOUBLE_EQ(evaluate(recording).comp1.time(), 812.0);
}

// Leaving the road and time-out count as crashes there.
TEST(Comp1, OnlyTheGoalIsSuccess) {
  Recording recording = cruise(5, 10.0);
  for (const Ending ending : {Ending::kCollision, Ending::kOffRoad, Ending::kTimeOut, Ending::kDeadEcu}) {
    recording.ending = ending;
    EXPECT_FALSE(evaluate(recording).comp1.success) << ending_name(ending);
  }
}

// Speeds 10, 10, 10.2, 10.4, 10.6 m/s are accelerations 0, 2, 2, 2 m/s^2 in 4 steps; the one difference, 2,
// squared over 4 steps is 1.
TEST(Comp1, JerkIsADifferenceOfAccelerationsSquared) {
  Recording recording = cruise(5, 10.0);
  for (std::size_t i = 2; i < 5; ++i) recording.snapshots[i].ego.speed_mps = 10.0 + 0.2 * (i - 1.0);
  EXPECT_NEAR(evaluate(recording).comp1.jerk_linear, 1.0, 1e-9);
  EXPECT_EQ(evaluate(recording).comp1.jerk_angular, 0.0);
}

// The velocity turns by 90 degrees at 10 m/s between steps 1 and 2, so in step 2 the acceleration is
// (-100, 100) m/s^2 and in step 3 none again: two differences of 20000 (m/s^2)^2 over 3 steps.
TEST(Comp1, JerkCountsTheDirection) {
  Recording recording = cruise(4, 10.0);
  for (std::size_t i = 2; i < 4; ++i) recording.snapshots[i].ego.heading_rad = std::acos(0.0);
  EXPECT_NEAR(evaluate(recording).comp1.jerk_linear, 2.0 * 20000.0 / 3.0, 1e-6);
}

// Yaw rates 0, 0, 0.1, 0.1 rad/s are angular accelerations 0, 1, 0 rad/s^2: two differences of 1 over 3
// steps.
TEST(Comp1, AngularJerkLikewise) {
  Recording recording = cruise(4, 10.0);
  recording.snapshots[2].ego.yaw_rate_radps = recording.snapshots[3].ego.yaw_rate_radps = 0.1;
  EXPECT_NEAR(evaluate(recording).comp1.jerk_angular, 2.0 / 3.0, 1e-9);
}

// Humanness is the plain sum of the four: exp(-1) of a car 20 m ahead, lane offset 0.25, no jerk.
TEST(Comp1, HumannessIsTheSum) {
  Recording recording = cruise(3, 10.0);
  for (Snapshot& snapshot : recording.snapshots) snapshot.ego_lane_offset_m = 0.8;
  recording.snapshots.back().others = {car_at(recording.snapshots.back().ego.centre.x + 20.0, 0.0)};
  EXPECT_NEAR(evaluate(recording).comp1.humanness(), std::exp(-1.0) + 0.25, 1e-12);
}

// 0.8 m off the centre of a 3.2 m lane is half of half the width: 0.25.
TEST(Comp1, LaneOffsetIsRelativeToHalfTheWidth) {
  Recording recording = cruise(4, 10.0);
  for (Snapshot& snapshot : recording.snapshots) snapshot.ego_lane_offset_m = 0.8;
  EXPECT_NEAR(evaluate(recording).comp1.lane_centre_offset, 0.25, 1e-12);
}

// Only the last step counts, only within 3 v and 40 degrees: 20 m straight ahead at 10 m/s gives exp(-1);
// behind nothing; 31 m ahead nothing.
TEST(Comp1, ObstacleTermLooksAheadAtTheEnd) {
  Recording recording = cruise(3, 10.0);
  const double here = recording.snapshots.back().ego.centre.x;
  const auto with = [&](double ahead_m) {
    recording.snapshots.back().others = {car_at(here + ahead_m, 0.0)};
    return evaluate(recording).comp1.obstacle;
  };
  EXPECT_NEAR(with(20.0), std::exp(-1.0), 1e-12);
  EXPECT_EQ(with(-20.0), 0.0);
  EXPECT_EQ(with(31.0), 0.0);
}

// 25 m between centres of 5 m cars: gap 20 m; closing at 5 m/s: 4 s to collision. RSS at 10 behind 5 m/s:
// 5 + 0.25 + 11^2 / 10 - 25 / 16 = 15.8 m, kept; at 18 m between centres (gap 13 m) it is not.
TEST(Metrics, GapTimeToCollisionAndRss) {
  Recording recording = cruise(1, 10.0);
  recording.snapshots[0].others = {car_at(25.0, 5.0)};
  recording.snapshots[0].others[0].id = 1;
  const EpisodeMetrics far = evaluate(recording);
  EXPECT_NEAR(far.min_gap_m, 20.0, 1e-9);
  EXPECT_NEAR(far.min_time_to_collision_s, 4.0, 1e-9);
  EXPECT_NEAR(far.encounters.mean_gap_m, 20.0, 1e-9);
  EXPECT_EQ(far.encounters.rss_violation_share, 0.0);
  recording.snapshots[0].others[0].centre.x = 18.0;
  EXPECT_EQ(evaluate(recording).encounters.rss_violation_share, 1.0);
}

// Diagonally 3 m and 4 m between the corners of cars of 5 x 1.8 m: 5 m, not the 4 m of the larger axis; a car
// half inside is no farther than one that touches: 0.
TEST(Metrics, GapIsBetweenBoxes) {
  Recording recording = cruise(1, 10.0);
  CarState other = car_at(8.0, 10.0);
  other.centre.y = 5.8;
  recording.snapshots[0].others = {other};
  EXPECT_NEAR(evaluate(recording).min_gap_m, 5.0, 1e-9);
  recording.snapshots[0].others = {car_at(2.5, 10.0)};
  EXPECT_EQ(evaluate(recording).min_gap_m, 0.0);
}

// The pre-roll (negative time) does not count.
TEST(Metrics, PreRollDoesNotCount) {
  Recording recording = cruise(10, 10.0);
  Snapshot before;
  before.time_s = -0.1;
  before.ego.acceleration_mps2 = -9.0;
  recording.snapshots.insert(recording.snapshots.begin(), before);
  EXPECT_EQ(evaluate(recording).hardest_braking_mps2, 0.0);
  EXPECT_DOUBLE_EQ(evaluate(recording).comp1.steps, 9.0);
}

// Accelerations 0, 2, 2, -4 m/s^2: jerks 20, 0 and 60 m/s^3, on average 80 / 3; rms sqrt(24 / 4); braking 4;
// at 10 m/s a yaw rate of 0.3 rad/s is 3 m/s^2 sideways.
TEST(Metrics, Comfort) {
  Recording recording = cruise(4, 10.0);
  recording.snapshots[1].ego.acceleration_mps2 = recording.snapshots[2].ego.acceleration_mps2 = 2.0;
  recording.snapshots[3].ego.acceleration_mps2 = -4.0;
  recording.snapshots[2].ego.yaw_rate_radps = -0.3;
  const EpisodeMetrics metrics = evaluate(recording);
  EXPECT_NEAR(metrics.mean_abs_jerk_mps3, 80.0 / 3.0, 1e-9);
  EXPECT_NEAR(metrics.max_abs_jerk_mps3, 60.0, 1e-9);
  EXPECT_NEAR(metrics.rms_acceleration_mps2, std::sqrt(6.0), 1e-12);
  EXPECT_EQ(metrics.hardest_braking_mps2, 4.0);
  EXPECT_NEAR(metrics.max_lateral_mps2, 3.0, 1e-12);
}

// 40 m of a Manhattan distance of 30 + 20 m, 25 m still to go: half of it covered, whatever the detour.
TEST(Metrics, Progress) {
  Recording recording = cruise(41, 10.0);
  recording.ending = Ending::kTimeOut;
  recording.goal = {30.0, -20.0};
  recording.goal_distance_m = 25.0;
  EXPECT_NEAR(evaluate(recording).distance_m, 40.0, 1e-9);
  EXPECT_NEAR(evaluate(recording).progress_share, 0.5, 1e-12);
  recording.ending = Ending::kGoal;
  EXPECT_EQ(evaluate(recording).progress_share, 1.0);
}

// A car comes across: its front is at y = -11.5, ours at x = 2.5. At 10 m/s each, ours reaches its side
// (x = 19.1) after 1.66 s, when its front is at y = 5.1 and its rear at 0.1, within our 0.9 m: contact then.
TEST(Metrics, TimeToCollisionSeesCrossingCars) {
  Recording recording = cruise(1, 10.0);
  CarState other = car_at(20.0, 10.0);
  other.centre.y = -14.0;
  other.heading_rad = std::acos(0.0);
  recording.snapshots[0].others = {other};
  EXPECT_NEAR(evaluate(recording).min_time_to_collision_s, 1.66, 1e-9);
}

// We stand at the origin. A car at (-5, 5) heads for us, -45 degrees, at 5 m/s, and turns left with 1 rad/s:
// on its arc, of radius 5 m, its centre falls by 5 (1 - cos 45) = 1.46 m to y = 3.54, where it is parallel to
// us, 1.74 m clear. Frozen headings would have it hit us within a second.
TEST(Metrics, TimeToCollisionFollowsTurns) {
  Recording recording = cruise(1, 0.0);
  CarState other = car_at(0.0, 5.0);
  other.centre.x = -5.0;
  other.centre.y = 5.0;
  other.heading_rad = -std::atan(1.0);
  recording.snapshots[0].others = {other};
  EXPECT_LT(evaluate(recording).min_time_to_collision_s, 1.0);
  recording.snapshots[0].others[0].yaw_rate_radps = 1.0;
  EXPECT_EQ(evaluate(recording).min_time_to_collision_s, kTtcHorizonS);
}

// Two cars 20 m apart on one circle of radius 50 m, both at 10 m/s: they never meet, though both are headed
// off it; when the one ahead stands still on it, the arc of 20 m less about 5 m takes 1.5 s.
TEST(Metrics, TimeToCollisionAlongABend) {
  Recording recording = cruise(1, 10.0);
  CarState& ego = recording.snapshots[0].ego;
  ego.centre = {0.0, -50.0};
  ego.yaw_rate_radps = 0.2;
  CarState other = car_at(0.0, 10.0);
  other.centre = {50.0 * std::sin(0.4), -50.0 * std::cos(0.4)};
  other.heading_rad = 0.4;
  other.yaw_rate_radps = 0.2;
  recording.snapshots[0].others = {other};
  EXPECT_EQ(evaluate(recording).min_time_to_collision_s, kTtcHorizonS);
  recording.snapshots[0].others[0].speed_mps = recording.snapshots[0].others[0].yaw_rate_radps = 0.0;
  EXPECT_NEAR(evaluate(recording).min_time_to_collision_s, 1.5, 0.1);
}

// 2 s to the goal are in time where 2.01 s are asked for, not where 1.9 are; 2 s to a time-out never are.
TEST(Metrics, InTimeIsAGoalByThen) {
  Recording recording = cruise(21, 10.0);
  scenario::Scenario scenario = straight();
  const auto is_in_time = [&](double in_time_s) {
    scenario.mission.in_time_s = in_time_s;
    return in_time(metrics::evaluate(recording, scenario));
  };
  recording.ending = Ending::kGoal;
  EXPECT_TRUE(is_in_time(2.01));
  EXPECT_FALSE(is_in_time(1.9));
  recording.ending = Ending::kTimeOut;
  EXPECT_FALSE(is_in_time(2.01));
}

// Unsafe, safe, unsafe: violated twice, two thirds of the time.
TEST(Metrics, RssViolationsAreCountedWhenTheyBegin) {
  Recording recording = cruise(3, 10.0);
  for (std::size_t i : {0U, 2U}) {
    recording.snapshots[i].others = {car_at(recording.snapshots[i].ego.centre.x + 18.0, 5.0)};
    recording.snapshots[i].others[0].id = 1;
  }
  EXPECT_EQ(evaluate(recording).encounters.rss_violations, 2);
  EXPECT_NEAR(evaluate(recording).encounters.rss_violation_share, 2.0 / 3.0, 1e-12);
}

// The world goes on for a second after a touch: a touch at 0.2 s ends what is measured there, so the braking
// at 0.3 s is not ours. It is counted with its cause and whose fault it was.
TEST(Metrics, NothingCountsAfterTheTouch) {
  Recording recording = cruise(5, 10.0);
  recording.ending = Ending::kCollision;
  recording.collisions = {{0.2, 1, traffic::Fault::kOther, traffic::Cause::kRanInto}};
  recording.snapshots[3].ego.acceleration_mps2 = -9.0;
  const EpisodeMetrics metrics = evaluate(recording);
  EXPECT_NEAR(metrics.duration_s, 0.2, 1e-12);
  EXPECT_EQ(metrics.hardest_braking_mps2, 0.0);
  EXPECT_EQ(metrics.cause, "was run into");
  EXPECT_EQ(metrics.collisions_other_fault, 1);
  EXPECT_EQ(metrics.collisions_at_fault, 0);
  EXPECT_FALSE(metrics.collided_standing);
}

// A car that stands when it is hit is told apart: with an engine outside, part of those is the coupling.
TEST(Metrics, HitWhileStanding) {
  Recording recording = cruise(3, 0.0);
  recording.ending = Ending::kCollision;
  recording.collisions = {{0.2, 1, traffic::Fault::kOther, traffic::Cause::kRanInto}};
  EXPECT_TRUE(evaluate(recording).collided_standing);
}

}  // namespace
}  // namespace s4tp::metrics
