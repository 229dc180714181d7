// The planning cycle as a whole: what comes out for whole, broken and empty worlds.

#include "algo/planner/planner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "algo/core/parameter_info.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/plan_limits.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/planner_drive.hpp"

namespace s4tp::planner {
namespace {

using test::car;
using test::kLaneWidthM;
using test::on_straight_road;
using test::straight_road;
using Drive = test::PlannerDrive;

// CORE-002: plan() before init() answers so and leaves the plan untouched.
TEST(Planner, RefusesBeforeInit) {
  const auto planner = std::make_unique<Planner>();
  Plan plan;
  plan.start_ms = 77;
  Explanation explanation;
  EXPECT_EQ(planner->plan(PlannerInput{}, plan, explanation), Status::kNotInitialized);
  EXPECT_EQ(plan.start_ms, 77U);
}

// CORE-003: a parameter out of range (wheelbase 0) keeps the planner from starting.
TEST(Planner, RefusesBadParameters) {
  Parameters parameters;
  parameters.vehicle.wheelbase_m = 0.0F;
  EXPECT_EQ(std::make_unique<Planner>()->init(parameters), Status::kInvalidParameter);
}

// CORE-001: on an empty road at the limit it goes on at the limit: after 3 s 13.89 +- 0.5 m/s in the lane
// centre.
TEST(Planner, HoldsTheLimitOnAnEmptyRoad) {
  Drive drive = on_straight_road(13.89F);
  for (int i = 0; i < 30; ++i) ASSERT_EQ(drive.step(), Status::kOk) << i;
  EXPECT_NEAR(drive.input.ego.speed_mps, 13.89F, 0.5F);
  EXPECT_NEAR(drive.input.ego.rear_axle.y_m, 0.0F, 0.1F);
}

// From standstill it starts by itself: more than 3 m/s after 3 s.
TEST(Planner, StartsFromStandstill) {
  Drive drive = on_straight_road(0.0F);
  for (int i = 0; i < 30; ++i) ASSERT_EQ(drive.step(), Status::kOk) << i;
  EXPECT_GT(drive.input.ego.speed_mps, 3.0F);
}

// CORE-006: without a map the answer is kNoLane and the plan a stop: 13 m/s at 4 m/s^2 takes 3.25 s, so the
// end of the horizon is below 2 m/s.
TEST(Planner, StopsWithoutAMap) {
  Drive drive = on_straight_road(13.0F);
  drive.has_map = false;
  EXPECT_EQ(drive.step(), Status::kNoLane);
  EXPECT_EQ(drive.running.kind, PlanKind::kMinimumRisk);
  EXPECT_LT(drive.running.trajectory.points[kHorizonSteps].speed_mps, 2.0F);
}

// CORE-003, CAND-020: with any one parameter at the least or the most it may be, and with all that may be at their least, three
// cycles behind a slower car give plans within the limits that these parameters say. A weight of 0 once left nothing to divide by.
TEST(Planner, PlansWithParametersAtTheirEnds) {
  const auto planner = std::make_unique<Planner>();
  const auto drive_with = [](const Parameters& parameters, const std::string& name) {
    SCOPED_TRACE(name);
    Drive drive = on_straight_road(10.0F, parameters);
    (void)drive.input.tracks.push(car(1, 60.0F, 0.0F, 0.0F, 8.0F));
    for (int cycle = 0; cycle < 3; ++cycle) {
      const Status status = drive.step();
      EXPECT_TRUE(status == Status::kOk || status == Status::kNoSafePlan) << status_name(status);
    }
  };
  Parameters least;
  int taken = 0;
  for (int i = 0; i < kParameterCount; ++i) {
    const ParameterInfo& info = parameter_info(i);
    for (const float end : {info.minimum, info.maximum}) {
      Parameters parameters;
      set_parameter(parameters, i, end);
      if (planner->init(parameters) != Status::kOk) continue;  // the others do not let it
      ++taken;
      drive_with(parameters, info.name);
    }
    const Parameters before = least;
    set_parameter(least, i, info.minimum);
    if (planner->init(least) != Status::kOk) least = before;
  }
  EXPECT_GT(taken, kParameterCount);
  drive_with(least, "all at their least");
}

// CORE-007: a car standing 8 m ahead across all lanes at 13 m/s: 13^2 / (2 * 8) = 10.6 m, nothing avoids it,
// and what is driven is the hardest stop there is.
TEST(Planner, BrakesWhenNothingIsSafe) {
  Drive drive = on_straight_road(13.0F);
  for (int lane = 0; lane < 3; ++lane) {
    ASSERT_TRUE(drive.input.tracks.push(car(lane + 1, 34.0F, 3.2F * static_cast<float>(lane), 0.0F, 0.0F)));
  }
  (void)drive.step();
  EXPECT_LT(drive.running.trajectory.points[10].speed_mps, 8.0F);
  EXPECT_GT(drive.explanation.risk.obstacle[0], 0.0F);  // CORE-072: and what it risks is told
  EXPECT_NE(drive.explanation.dominating_track, 255);
}

// Behind a car standing 80 m ahead in a single lane it comes to rest before it, without a collision on the
// way.
TEST(Planner, StopsBehindAStandingCar) {
  Drive drive(straight_road(1, 400.0F));
  drive.input.ego.rear_axle = {20.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = 13.0F;
  ASSERT_TRUE(drive.input.tracks.push(car(1, 100.0F, 0.0F, 0.0F, 0.0F)));
  for (int i = 0; i < 150; ++i) (void)drive.step();
  EXPECT_LT(drive.input.ego.speed_mps, 0.3F);
  const float front_m = drive.input.ego.rear_axle.x_m + 4.0F;
  EXPECT_LT(front_m, 97.5F);  // its rear bumper
  EXPECT_GT(front_m, 85.0F);  // and not absurdly far from it
}

// CORE-035: the same when the standing car shares its id with one that stands behind us, named before it or
// after.
TEST(Planner, StopsBehindAStandingCarThatSharesItsId) {
  for (const bool named_first : {true, false}) {
    Drive drive(straight_road(1, 400.0F));
    drive.input.ego.rear_axle = {60.0F, 0.0F, 0.0F};
    drive.input.ego.speed_mps = 13.0F;
    ASSERT_TRUE(drive.input.tracks.push(car(7, named_first ? 120.0F : 10.0F, 0.0F, 0.0F, 0.0F)));
    ASSERT_TRUE(drive.input.tracks.push(car(7, named_first ? 10.0F : 120.0F, 0.0F, 0.0F, 0.0F)));
    for (int i = 0; i < 100; ++i) {
      (void)drive.step();
      ASSERT_EQ(drive.explanation.id_clashes, 2);
    }
    EXPECT_LT(drive.input.ego.speed_mps, 0.3F);
    EXPECT_LT(drive.input.ego.rear_axle.x_m + 4.0F, 117.5F);
  }
}

// A slow car ahead and two free lanes beside: it passes. After 20 s it is ahead of a car at 5 m/s (40 + 100
// m).
TEST(Planner, OvertakesASlowCar) {
  Drive drive = on_straight_road(13.0F);
  ASSERT_TRUE(drive.input.tracks.push(car(1, 60.0F, 0.0F, 0.0F, 5.0F)));
  for (int i = 0; i < 150; ++i) ASSERT_NE(drive.step(), Status::kInvalidInput);
  EXPECT_GT(drive.input.ego.rear_axle.x_m, drive.input.tracks[0].centre.x_m);
}

/// Two lanes, 400 m: the right one is the route's, the left one a change away from it.
LaneMap road_with_goal_right() {
  LaneMap map = straight_road(2, 400.0F);
  map.lanes[1].changes_needed = -1;
  return map;
}

// Overtaking pays: behind a car at 5 m/s 360 m would take 72 s. It passes, and is back in its lane, ahead, in
// half of that time.
TEST(Planner, OvertakesAndReturns) {
  Drive drive(road_with_goal_right());
  drive.input.ego.rear_axle = {20.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = 13.0F;
  ASSERT_TRUE(drive.input.tracks.push(car(1, 60.0F, 0.0F, 0.0F, 5.0F)));
  for (int i = 0; i < 360 && drive.input.ego.rear_axle.x_m < 380.0F; ++i) (void)drive.step();
  EXPECT_GE(drive.input.ego.rear_axle.x_m, 380.0F);
  EXPECT_NEAR(drive.input.ego.rear_axle.y_m, 0.0F, 0.5F);
}

// It does not pay 60 m before the goal behind a car at 9 m/s: it stays in its lane.
TEST(Planner, StaysBehindJustBeforeTheGoal) {
  Drive drive(road_with_goal_right());
  drive.input.ego.rear_axle = {340.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = 10.0F;
  ASSERT_TRUE(drive.input.tracks.push(car(1, 370.0F, 0.0F, 0.0F, 9.0F)));
  for (int i = 0; i < 50; ++i) {
    (void)drive.step();
    ASSERT_LT(std::abs(drive.input.ego.rear_axle.y_m), 0.5F) << i;
  }
}

// Our lane ends after 200 m, and a column of five cars drives abreast where we have to go. It lets them pass
// or gets in between, and is in the other lane in the end: one attempt that fails is not the last.
TEST(Planner, ChangesLaneAfterBlockedAttempts) {
  LaneMap map = straight_road(2, 400.0F);
  map.lanes[0].points[1].x_m = 200.0F;
  map.lanes[0].length_m = map.lanes[0].route_remaining_m = 200.0F;
  map.lanes[0].changes_needed = 1;
  Drive drive(map);
  drive.input.ego.rear_axle = {60.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = 10.0F;
  for (int i = 0; i < 5; ++i) {
    const float x_m = 80.0F - 12.0F * static_cast<float>(i);
    ASSERT_TRUE(drive.input.tracks.push(car(i + 1, x_m, kLaneWidthM, 0.0F, 10.0F)));
  }
  for (int i = 0; i < 400; ++i) (void)drive.step();
  EXPECT_NEAR(drive.input.ego.rear_axle.y_m, kLaneWidthM, 0.5F);
  EXPECT_GT(drive.input.ego.rear_axle.x_m, 200.0F);
}

// Every plan says why: terms add up to a score, the runner-up is not better, the parameters' CRC is there.
TEST(Planner, ExplainsItsChoice) {
  Drive drive = on_straight_road(10.0F);
  ASSERT_EQ(drive.step(), Status::kOk);
  EXPECT_GT(drive.explanation.candidate_count, 1);
  EXPECT_GE(drive.explanation.decisions, 1);
  if (drive.explanation.decisions > 1) {
    EXPECT_LE(drive.explanation.chosen_cost.total(), drive.explanation.runner_up_cost.total());
  }
  EXPECT_EQ(drive.explanation.parameters_crc, parameters_crc(Parameters{}));
}

/// Keeps what the planner saw and predicted.
class Witness final : public Probe {
 public:
  void stage_begin(Stage) override {}
  void stage_end(Stage) override {}
  void cycle_done(const scene::Scene& of, const satp::PredictionSet& expected,
                  const sadrf::RiskProfile&) override {
    scene = of;
    prediction = expected;
  }
  scene::Scene scene;
  satp::PredictionSet prediction;
};

// CORE-072: behind a slower car every plan carries the risk of each of its steps: that of the very trajectory
// given, clipped or not; the dominating cause is that car, at the step where its share is largest.
TEST(Planner, EveryPlanCarriesItsRiskAndItsCause) {
  Drive drive(straight_road(1, 400.0F));
  drive.input.ego.rear_axle = {20.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = 12.0F;
  ASSERT_TRUE(drive.input.tracks.push(car(7, 52.0F, 0.0F, 0.0F, 8.0F)));
  const auto witness = std::make_unique<Witness>();
  const auto area = std::make_unique<sadrf::DrivableArea>();
  drive.planner->probe = witness.get();
  for (int cycle = 0; cycle < 10; ++cycle) {
    ASSERT_EQ(drive.step(), Status::kOk);
    const Explanation& why = drive.explanation;
    sadrf::RiskProfile expected;
    sadrf::build_drivable(witness->scene.map, *area);
    sadrf::exact_risk(witness->scene, *area, witness->prediction, {}, drive.running.trajectory, Parameters{},
                      expected);
    float largest = 0.0F;
    for (int i = 0; i < kHorizonSteps; ++i) {
      ASSERT_EQ(why.risk.obstacle[i], expected.obstacle[i]) << cycle << ' ' << i;
      ASSERT_EQ(why.risk.road[i], expected.road[i]) << cycle << ' ' << i;
      ASSERT_EQ(why.risk.social[i], expected.social[i]) << cycle << ' ' << i;
      largest = std::max(largest, why.risk.obstacle[i]);
    }
    ASSERT_GT(largest, 0.0F);
    EXPECT_EQ(why.dominating_track, 7);
    EXPECT_EQ(why.risk.obstacle[why.dominating_step], largest);
    // CORE-077 What the plan rests on: whether that car is expected to let us pass, and how likely that is.
    float yields = 0.0F;
    for (const satp::Mode& mode : witness->prediction.agents[0].modes)
      yields += 0.01F * static_cast<float>(mode.yields_percent) * mode.probability;
    EXPECT_EQ(why.rests_on.yields, yields > 0.5F);
    EXPECT_NEAR(why.rests_on.probability, std::max(yields, 1.0F - yields), 1e-6F);
  }
}

// Work allowances cut at the same place every time and still give a plan: one candidate, one decision.
TEST(Planner, LivesWithTheSmallestAllowance) {
  Drive drive = on_straight_road(10.0F);
  drive.planner->allowance.candidates = 1;
  drive.planner->allowance.decisions = 1;
  (void)drive.step();
  EXPECT_EQ(drive.explanation.candidate_count, 1);
  EXPECT_NE(drive.running.kind, PlanKind::kNone);
  EXPECT_GT(drive.explanation.left_out, 0);
}

// The same inputs give the same plans to the last bit, whatever the planner did before its init().
TEST(Planner, IsDeterministic) {
  Drive first = on_straight_road(12.0F);
  Drive second = on_straight_road(3.0F);
  (void)second.step();
  second = on_straight_road(12.0F);
  for (Drive* drive : {&first, &second}) {
    ASSERT_TRUE(drive->input.tracks.push(car(1, 55.0F, 0.0F, 0.0F, 7.0F)));
    ASSERT_TRUE(drive->input.tracks.push(car(2, 10.0F, 3.2F, 0.0F, 13.0F)));
  }
  for (int i = 0; i < 20; ++i) {
    (void)first.step();
    (void)second.step();
    ASSERT_EQ(std::memcmp(&first.running.trajectory, &second.running.trajectory, sizeof(Trajectory)), 0) << i;
  }
}

}  // namespace
}  // namespace s4tp::planner
