// Metrics from constructed recordings: the arithmetic of the competition's evaluator and of our own.

#include "sim_host/metrics/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_host/metrics/summary.hpp"

namespace s4tp::metrics {
namespace {

using world::CarState;
using world::Ending;
using world::Recording;
using world::Snapshot;

CarState car_at(double x, double speed_mps) {
  CarState car;
  car.centre = {x, 0.0};
  car.speed_mps = speed_mps;
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

// 50 steps to the goal cost 50; a crash costs 800 plus the way still to go (12 m).
TEST(Comp1, TimeIsStepsPlusDistance) {
  Recording recording = cruise(50, 10.0);
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

// Acceleration steps once from 0 to 2 m/s^2: 2^2 over the 4 differences of 6 snapshots = 1; in true units one
// difference of 2 / 0.1 s = 20 m/s^3 over 5 differences = 4.
TEST(Comp1, JerkIsADifferenceSquared) {
  Recording recording = cruise(6, 10.0);
  for (std::size_t i = 3; i < 6; ++i) recording.snapshots[i].ego.acceleration_mps2 = 2.0;
  EXPECT_NEAR(evaluate(recording).comp1.jerk_linear, 1.0, 1e-12);
  EXPECT_NEAR(evaluate(recording).mean_abs_jerk_mps3, 4.0, 1e-12);
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
  const EpisodeMetrics far = evaluate(recording);
  EXPECT_NEAR(far.min_gap_m, 20.0, 1e-9);
  EXPECT_NEAR(far.min_time_to_collision_s, 4.0, 1e-9);
  EXPECT_EQ(far.rss_violation_share, 0.0);
  recording.snapshots[0].others = {car_at(18.0, 5.0)};
  EXPECT_EQ(evaluate(recording).rss_violation_share, 1.0);
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
  EXPECT_DOUBLE_EQ(evaluate(recording).comp1.steps, 10.0);
}

// METHOD: 500 of 500 only bounds the failure rate below 0.8 %. 16 of 20: 58.4 .. 91.9 % (tabulated).
TEST(Summary, WilsonInterval) {
  EXPECT_NEAR(wilson(500, 500).low, 0.9924, 5e-4);
  EXPECT_NEAR(wilson(16, 20).low, 0.584, 1e-3);
  EXPECT_NEAR(wilson(16, 20).high, 0.919, 1e-3);
  EXPECT_EQ(wilson(0, 0).high, 1.0);
}

// Two goals after 4 and 6 s and one collision of ours: 5 s on average, one of three lost.
TEST(Summary, CountsAndAverages) {
  std::vector<EpisodeMetrics> episodes(3);
  episodes[0].ending = episodes[1].ending = Ending::kGoal;
  episodes[0].duration_s = 4.0;
  episodes[1].duration_s = 6.0;
  episodes[2].ending = Ending::kCollision;
  episodes[2].collisions_at_fault = 1;
  const Summary sum = summarize(episodes);
  EXPECT_EQ(sum.goals, 2);
  EXPECT_DOUBLE_EQ(sum.seconds_to_goal, 5.0);
  EXPECT_EQ(sum.with_collision, 1);
  EXPECT_EQ(sum.with_own_fault, 1);
}

}  // namespace
}  // namespace s4tp::metrics
