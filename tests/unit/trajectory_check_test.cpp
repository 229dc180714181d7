// The last look at a trajectory.

#include "algo/safety/trajectory_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algo/core/math.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "tests/support/driving_scenes.hpp"

namespace s4tp {
namespace {

using namespace test;  // NOLINT: the map builders are the language of these tests

/// Two lanes along +x, we at s = 100 on the right one.
struct Road {
  LaneMap map = straight_road(2, 400.0F);
  Scene scene;
  Parameters parameters;
  PredictionSet unconditioned;
  PredictionSet conditioned;
  KinematicSet keep_going;

  Road() {
    add_way(scene, map, path_of(map, {0}));
    put_ego(scene, state_on(map, scene.ego_paths[0].path, 100.0F, 0.0F));
  }
  Trajectory drive(float speed_mps, float acceleration_mps2 = 0.0F, float curvature_rate = 0.0F) {
    scene.ego.speed_mps = speed_mps;
    Trajectory trajectory;
    trajectory.points[0] = state_on(map, scene.ego_paths[0].path, 100.0F, speed_mps);
    for (int i = 1; i < kTrajectoryPoints; ++i)
      trajectory.points[i] =
          bicycle_step(trajectory.points[i - 1], acceleration_mps2, curvature_rate, kStepS);
    return trajectory;
  }
  /// A vehicle that is also predicted, to go on as it does.
  Agent& vehicle(int lane, float s_m, float speed_mps, float d_m = 0.0F) {
    Agent& agent = add_vehicle(scene, map, path_of(map, {static_cast<LaneIndex>(lane)}), s_m, speed_mps, d_m);
    (void)keep_going.agents.push(steady_future(map, agent));
    return agent;
  }
  void predict(PredictionSet& set, int agent, const Mode& mode) {
    for (AgentPrediction& known : set.agents) {
      if (known.agent == agent) {
        (void)known.modes.push(mode);
        return;
      }
    }
    AgentPrediction prediction;
    prediction.agent = static_cast<std::uint8_t>(agent);
    (void)prediction.modes.push(mode);
    (void)set.agents.push(prediction);
  }
  [[nodiscard]] CheckReport check(const Trajectory& trajectory) const {
    return check_trajectory(scene, 0, trajectory, unconditioned, conditioned, keep_going, parameters);
  }
};

// CHECK-001 Straight on, a car in the next lane beside us and one 60 m ahead as fast: passed, nobody named.
TEST(Check, PassesOrdinaryDriving) {
  Road road;
  road.vehicle(1, 101.0F, 10.0F);
  road.vehicle(0, 160.0F, 10.0F);
  const CheckReport report = road.check(road.drive(10.0F));
  EXPECT_EQ(report.result, CheckResult::kPassed);
  EXPECT_EQ(report.agent, 255);
}

// CHECK-002 One value of one point that is not finite is enough, whichever it is.
TEST(Check, RejectsWhatIsNotFinite) {
  Road road;
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  for (const float value : bad) {
    for (int field = 0; field < 6; ++field) {
      Trajectory trajectory = road.drive(10.0F);
      TrajectoryPoint& point = trajectory.points[17];
      float* const fields[] = {&point.rear_axle.x_m, &point.rear_axle.y_m,     &point.rear_axle.heading_rad,
                               &point.speed_mps,     &point.acceleration_mps2, &point.curvature_1pm};
      *fields[field] = value;
      EXPECT_EQ(road.check(trajectory).result, CheckResult::kNotFinite) << field;
    }
  }
}

// CHECK-003 10 m/s on a curvature that grows by 0.05 / m each second: 4.5 m/s^2 sideways are passed after 0.9
// s.
TEST(Check, RejectsWhatTheCarCannotDo) {
  Road road;
  EXPECT_EQ(road.check(road.drive(10.0F, 0.0F, 0.05F)).result, CheckResult::kInfeasible);
}

// CHECK-004 A car standing 20 m ahead of our front (s = 124 to its rear) is met with 0.3 m of margin
// after 19.7 m, at 15 m/s after 1.3 s: within what "keeps going" covers, point 14, index 13.
TEST(Check, RejectsARunIntoAStandingCar) {
  Road road;
  road.vehicle(0, 126.5F, 0.0F);
  const CheckReport report = road.check(road.drive(15.0F));
  EXPECT_EQ(report.result, CheckResult::kCollision);
  EXPECT_EQ(report.agent, 0);
  EXPECT_EQ(report.step, 13);
}

// CHECK-004 Later than 1.5 s only predicted futures count: without and with our plan alike, any mode of them.
TEST(Check, EveryModeOfBothPredictionsCounts) {
  for (const bool conditioned : {false, true}) {
    Road road;
    road.vehicle(1, 125.0F, 10.0F);  // beside, ahead
    Mode stays = steady_future(road.map, road.scene.agents[0]);
    Mode cuts_in = stays;
    for (int i = 15; i < kHorizonSteps; ++i) cuts_in.steps[i] = {125.0F, 0.0F, 0.0F};
    PredictionSet& set = conditioned ? road.conditioned : road.unconditioned;
    road.predict(set, 0, stays);
    EXPECT_EQ(road.check(road.drive(10.0F)).result, CheckResult::kPassed);
    road.predict(set, 0, cuts_in);
    EXPECT_EQ(road.check(road.drive(10.0F)).result, CheckResult::kCollision);
  }
}

// CHECK-005 Nobody is hit, but the road ends 10 m after the plan does, at 20 m/s.
TEST(Check, RejectsAnUnsafeEnd) {
  Road road;
  road.map.lanes[0].on_route = false;
  put_ego(road.scene, state_on(road.map, road.scene.ego_paths[0].path, 330.0F, 20.0F));
  Trajectory trajectory = road.drive(20.0F);
  for (TrajectoryPoint& point : trajectory.points) point.rear_axle.x_m += 230.0F;
  EXPECT_EQ(road.check(trajectory).result, CheckResult::kTerminal);
  EXPECT_EQ(check_trajectory(road.scene, 1, trajectory, {}, {}, {}, road.parameters).result,
            CheckResult::kTerminal);  // no such path
}

// CHECK-006 A crossing car 20 m from the zone at 10 m/s would hit us if it kept going. It owes us the way and
// needs 100 / 40 = 2.5 m/s^2: forgiven. With the right of way, or needing more than 4, it is not; nor is a
// future in which it yields and still hits us.
TEST(Check, TrustsThoseWhoOweUsTheWay) {
  struct Case {
    Priority priority;
    float to_entry_m;
    float acceleration_mps2;
    bool yields;
    CheckResult result;
  };
  const Case cases[] = {
      {Priority::kFirstHasPriority, 20.0F, 0.0F, false, CheckResult::kPassed},
      {Priority::kFirstYields, 20.0F, 0.0F, false, CheckResult::kCollision},
      {Priority::kFirstYields, 20.0F, -3.0F, false, CheckResult::kPassed},  // already stopping before it
      {Priority::kFirstHasPriority, 10.0F, 0.0F, false, CheckResult::kCollision},
      {Priority::kFirstHasPriority, 20.0F, 0.0F, true, CheckResult::kCollision},
  };
  for (const Case& c : cases) {
    Road road;
    const LaneIndex other = add_lane(road.map, {{120.0F, -100.0F}, {120.0F, 100.0F}});
    ConflictZone zone;
    zone.entry_s_m = 116.0F;
    zone.exit_s_m = 124.0F;
    zone.stop_s_m = 115.0F;
    zone.other_lane = other;
    zone.other_entry_m = 96.0F;
    zone.other_exit_m = 104.0F;
    zone.priority = c.priority;
    (void)road.scene.ego_paths[0].zones.push(zone);
    Agent& agent = add_vehicle(road.scene, road.map, path_of(road.map, {other}), 96.0F - c.to_entry_m, 10.0F);
    agent.track.acceleration_mps2 = c.acceleration_mps2;
    Mode mode = steady_future(road.map, agent);
    mode.yields = c.yields;
    road.predict(road.unconditioned, 0, mode);
    const float speed_mps = 7.0F * 22.0F / (c.to_entry_m + 4.0F);  // so that we meet
    const CheckReport report = road.check(road.drive(speed_mps));
    if (c.result == CheckResult::kPassed) {
      EXPECT_NE(report.result, CheckResult::kCollision) << c.to_entry_m;
    } else {
      EXPECT_EQ(report.result, c.result) << c.to_entry_m << ' ' << c.yields;
    }
  }
}

// CHECK-009 We are 2.5 m inside a zone at 3 m/s; one with right of way sets off 6 m before it at 2 m/s, and
// would hit us if he went on. He sees us and can stop with 0.3 m/s^2: we go on, for to stop would leave us in
// his way. Not so at 10 m/s, nor while we are still before the zone.
TEST(Check, ACrossingUnderWayIsFinishedInFrontOfWhoSetsOff) {
  const auto result = [](float entry_s_m, float speed_mps) {
    Road road;
    const LaneIndex other = add_lane(road.map, {{105.0F, -100.0F}, {105.0F, 100.0F}});
    ConflictZone zone;
    zone.entry_s_m = entry_s_m;
    zone.exit_s_m = 112.0F;
    zone.stop_s_m = 96.0F;
    zone.other_lane = other;
    zone.other_entry_m = 96.0F;
    zone.other_exit_m = 104.0F;
    zone.priority = Priority::kFirstYields;
    (void)road.scene.ego_paths[0].zones.push(zone);
    add_vehicle(road.scene, road.map, path_of(road.map, {other}), 90.0F, speed_mps);
    Mode mode;
    mode.probability = 1.0F;
    for (Pose& step : mode.steps) step = {105.0F, 0.0F, 0.5F * kPi};  // in our way
    road.predict(road.unconditioned, 0, mode);
    return road.check(road.drive(3.0F)).result;
  };
  EXPECT_EQ(result(99.0F, 2.0F), CheckResult::kPassed);
  EXPECT_EQ(result(99.0F, 10.0F), CheckResult::kCollision);
  EXPECT_EQ(result(105.0F, 2.0F), CheckResult::kCollision);
}

// CHECK-011 We are inside a zone at 1.5 m/s; one has stood for 20 s, 3.1 m ahead of our front, and is trusted
// to let us pass. With its front on our centre line we would be 0.3 m from it after (3.1 - 0.3) / 1.5 = 1.9
// s: later than who keeps going is looked at otherwise. With its front 2.5 m beside the line nothing is in
// the way.
TEST(Check, WhoStandsInOurWayIsNotPassedThrough) {
  for (const float front_y_m : {0.0F, -2.5F}) {
    Road road;
    const LaneIndex other = add_lane(road.map, {{108.0F, -100.0F}, {108.0F, 100.0F}});
    ConflictZone zone;
    zone.entry_s_m = 99.0F;
    zone.exit_s_m = 115.0F;
    zone.stop_s_m = 96.0F;
    zone.other_lane = other;
    zone.other_entry_m = 99.0F;
    zone.other_exit_m = 104.0F;
    zone.priority = Priority::kFirstYields;
    (void)road.scene.ego_paths[0].zones.push(zone);
    road.vehicle(other, 100.0F + front_y_m - 2.5F, 0.0F).idle_ms = 20'000;
    const CheckReport report = road.check(road.drive(1.5F));
    EXPECT_EQ(report.result, front_y_m < -1.0F ? CheckResult::kPassed : CheckResult::kCollision) << front_y_m;
    if (report.result == CheckResult::kCollision) {
      EXPECT_EQ(report.step, 18);
    }
  }
}

// CHECK-007 One 6 m behind us at 15 m/s runs into us if he keeps going: his affair, while we are in our lane.
// Who is as near in the lane we cut into is ours.
TEST(Check, HitFromBehindIsNoReason) {
  Road road;
  road.vehicle(0, 100.0F - 1.0F - 6.0F - 2.5F, 15.0F);
  road.predict(road.unconditioned, 0, road.keep_going.agents[0]);
  EXPECT_EQ(road.check(road.drive(10.0F, -2.0F)).result, CheckResult::kPassed);
  put_ego(road.scene, state_on(road.map, road.scene.ego_paths[0].path, 100.0F, 10.0F, 3.2F));
  EXPECT_EQ(road.check(road.drive(10.0F, -2.0F)).result, CheckResult::kCollision);
}

// CHECK-010 In the lane we come to, at 10 m/s, one at 13 m/s drives on into us. From 6 m behind he can stay
// there with 3 m/s^2 (3.5 m needed): a change under way goes on; it is not begun, nor gone on with from 3 m.
TEST(Check, AChangeUnderWayIsFinishedInFrontOfWhoCanStayBehind) {
  const auto result = [](float gap_m, bool begun) {
    Road road;
    add_way(road.scene, road.map, path_of(road.map, {1}), Manoeuvre::kLeft);
    TrajectoryPoint start = state_on(road.map, road.scene.ego_paths[0].path, 100.0F, 10.0F);
    if (begun) {
      start.rear_axle.y_m = 0.6F;
      start.rear_axle.heading_rad = 0.08F;
    }
    put_ego(road.scene, start);
    road.vehicle(1, 99.0F - gap_m - 2.5F, 13.0F);
    road.predict(road.unconditioned, 0, road.keep_going.agents[0]);
    Trajectory trajectory;
    trajectory.points[0] = start;
    for (int i = 1; i < kTrajectoryPoints; ++i) {
      TrajectoryPoint& point = trajectory.points[i];
      point = trajectory.points[i - 1];
      point.rear_axle.x_m += 1.0F;
      if (point.rear_axle.y_m < kLaneWidthM) point.rear_axle.y_m += 0.15F;
    }
    return check_trajectory(road.scene, 1, trajectory, road.unconditioned, road.conditioned, road.keep_going,
                            road.parameters)
        .result;
  };
  EXPECT_EQ(result(6.0F, true), CheckResult::kPassed);
  EXPECT_EQ(result(6.0F, false), CheckResult::kCollision);
  EXPECT_EQ(result(3.0F, true), CheckResult::kCollision);
}

// CHECK-008 A car standing 0.2 m beside us (margin 0.3 m) does not freeze us; steering 0.15 m nearer counts.
TEST(Check, StandingCloseIsNoCollision) {
  Road road;
  Agent& agent = road.vehicle(0, 101.5F, 0.0F, 2.0F);
  Trajectory trajectory = road.drive(3.0F);
  const Mode& mode = road.keep_going.agents[0];
  EXPECT_EQ(first_collision(trajectory, mode, agent.track, kHorizonSteps, 0.3F, road.parameters), -1);
  for (int i = 1; i < kTrajectoryPoints; ++i)
    trajectory.points[i].rear_axle.y_m += 0.03F * static_cast<float>(i < 5 ? i - 1 : 5);
  EXPECT_GE(first_collision(trajectory, mode, agent.track, kHorizonSteps, 0.3F, road.parameters), 1);
}

// CHECK-008 Two boxes that overlap from the start (a flaw of perception) do not forbid every motion, only the
// one that goes on into the other.
TEST(Check, OverlapFromTheStart) {
  Road road;
  Agent& agent = road.vehicle(0, 106.0F, 0.0F);  // its rear at 103.5, our front at 104
  const Mode& mode = road.keep_going.agents[0];
  EXPECT_EQ(first_collision(road.drive(0.0F), mode, agent.track, kHorizonSteps, 0.3F, road.parameters), -1);
  EXPECT_GE(first_collision(road.drive(2.0F), mode, agent.track, kHorizonSteps, 0.3F, road.parameters), 1);
}

}  // namespace
}  // namespace s4tp
