// The C facade: same plans as the planner's own, and nothing from one that is none.

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "algo/api/s4tp.h"
#include "algo/core/parameter_info.hpp"
#include "algo/planner/planner.hpp"
#include "tests/support/c_facade.hpp"

namespace s4tp {
namespace {

using test::CFacade;
using test::kNaN;

// API-011: ten cycles beside the planner itself; every number of every plan and of its explanation is the
// same.
TEST_F(CFacade, PlansAsThePlannerDoes) {
  const auto planner = std::make_unique<planner::Planner>();
  ASSERT_EQ(planner->init(Parameters{}), Status::kOk);
  planner::PlannerInput core;
  Plan expected;
  planner::Explanation reason;
  int driven = 0;
  for (int cycle = 0; cycle < 10; ++cycle) {
    input.running = &plan;
    core.running = &expected;
    core.map = &core_map;
    core.now_ms = core.tracks_ms = tracks.time_ms = input.now_ms;
    core.start_ms = input.start_ms = input.now_ms + 100;
    core.ego.rear_axle = {input.ego.x_m, input.ego.y_m, input.ego.heading_rad};
    core.ego.speed_mps = input.ego.speed_mps;
    core.tracks.clear();
    Track other;
    other.id = 5;
    other.centre = {tracks.items[0].x_m, 1.6F, -3.14159F};
    other.speed_mps = 10.0F;
    other.length_m = 4.6F;
    other.width_m = 1.8F;
    ASSERT_TRUE(core.tracks.push(other));

    Plan next;
    const Status status = planner->plan(core, next, reason);
    expected = next;
    ASSERT_EQ(plan_now(), static_cast<s4tp_status>(status));
    driven += status == Status::kOk ? 1 : 0;

    ASSERT_EQ(plan.kind, static_cast<std::uint32_t>(expected.kind));
    ASSERT_EQ(plan.start_ms, expected.start_ms);
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      const TrajectoryPoint& point = expected.trajectory.points[i];
      ASSERT_EQ(plan.points[i].x_m, point.rear_axle.x_m);
      ASSERT_EQ(plan.points[i].y_m, point.rear_axle.y_m);
      ASSERT_EQ(plan.points[i].heading_rad, point.rear_axle.heading_rad);
      ASSERT_EQ(plan.points[i].speed_mps, point.speed_mps);
      ASSERT_EQ(plan.points[i].acceleration_mps2, point.acceleration_mps2);
      ASSERT_EQ(plan.points[i].curvature_1pm, point.curvature_1pm);
    }
    EXPECT_EQ(plan.lane_change, static_cast<std::uint8_t>(expected.manoeuvre.lane_change));
    EXPECT_EQ(why.chosen.cost_total, reason.chosen_cost.total());
    EXPECT_EQ(why.candidates, reason.candidate_count);
    EXPECT_EQ(why.dominating_track, reason.dominating_track);
    EXPECT_EQ(why.parameters_crc, reason.parameters_crc);
    int rejected = 0;
    int all = 0;
    for (int i = 0; i < reason.candidate_count; ++i)
      rejected += reason.rejections[i] != trajectory::Rejection::kNone ? 1 : 0;
    for (const std::uint8_t count : why.rejected) all += count;
    EXPECT_EQ(all, rejected);
    for (int i = 0; i < planner::kStageCount; ++i) EXPECT_EQ(why.work[i], reason.work[i]);

    input.now_ms += 100;
    s4tp_plan_point now;
    ASSERT_EQ(s4tp_sample(&plan, input.now_ms, &now), S4TP_OK);
    input.ego = {now.x_m, now.y_m, now.heading_rad, now.speed_mps, 0.0F, 0.0F, 0.0F};
    tracks.items[0].x_m -= 1.0F;
  }
  EXPECT_EQ(driven, 10);
}

// Times wrap: a drive across 2^32 ms has the plans of the same drive an hour after the start, to the bit.
TEST_F(CFacade, PlansTheSameAcrossTheEndOfTime) {
  const auto drive = [this](std::uint32_t begin_ms) {
    EXPECT_EQ(s4tp_init(block.get(), nullptr, nullptr), S4TP_OK);
    std::vector<s4tp_plan> plans;
    input.now_ms = begin_ms;
    input.ego = {-30.0F, -1.6F, 0.0F, 8.0F, 0.0F, 0.0F, 0.0F};
    input.running = nullptr;
    tracks.items[0].x_m = 40.0F;
    for (int cycle = 0; cycle < 20; ++cycle) {
      input.start_ms = input.now_ms + 100U;
      tracks.time_ms = input.now_ms - 30U;
      EXPECT_EQ(plan_now(), S4TP_OK) << cycle;
      EXPECT_EQ(plan.start_ms, input.start_ms);
      plans.push_back(plan);
      plans.back().start_ms = 0;
      input.running = &plan;
      input.now_ms += 100U;
      s4tp_plan_point now;
      EXPECT_EQ(s4tp_sample(&plan, input.now_ms, &now), S4TP_OK);
      input.ego = {now.x_m, now.y_m, now.heading_rad, now.speed_mps, 0.0F, 0.0F, 0.0F};
      tracks.items[0].x_m -= 1.0F;
    }
    return plans;
  };
  const std::vector<s4tp_plan> later = drive(3'600'000U);
  const std::vector<s4tp_plan> across = drive(0xFFFFFFFFU - 1049U);
  for (std::size_t i = 0; i < later.size(); ++i) {
    EXPECT_EQ(std::memcmp(&later[i], &across[i], sizeof(s4tp_plan)), 0) << i;
  }
}

// API-017: a list of nobody that left 300 out vouches for no ground at all: at 8 m/s only braking as hard as the
// fail-safe is left, and the explanation says for whom. The same list, nobody left out: we drive. Of 300 it tells 255.
TEST_F(CFacade, WhomTheListLeftOutIsReckonedWith) {
  tracks.count = 0;
  EXPECT_EQ(plan_now(), S4TP_OK);
  EXPECT_EQ(why.tracks_left_out, 0);
  EXPECT_EQ(why.unseen, 0);
  EXPECT_GT(plan.points[30].speed_mps, 5.0F);
  input.now_ms += 100;
  input.start_ms += 100;
  tracks.time_ms += 100;
  tracks.left_out = 300;
  map.lanes_left_out = 7;
  EXPECT_EQ(plan_now(), S4TP_OK);
  EXPECT_EQ(plan.points[20].speed_mps, 0.0F);
  EXPECT_EQ(why.tracks_left_out, 255);
  EXPECT_EQ(why.lanes_left_out, 7);
  EXPECT_EQ(why.unseen, 1);
}

// API-012: no map is not an error of the caller's, but there is only one thing to do.
TEST_F(CFacade, WithoutMapOrListDrivesAsTheCoreDoes) {
  input.map = nullptr;
  EXPECT_EQ(plan_now(), S4TP_NO_LANE);
  EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_MINIMUM_RISK));
  input.map = &map;
  input.tracks = nullptr;
  EXPECT_EQ(plan_now(), S4TP_OK);
}

// API-013: without a planner or an argument nothing is written.
TEST_F(CFacade, WritesNothingWithoutPlannerOrArgument) {
  plan.start_ms = 77;
  why.candidates = 99;
  const auto fresh = std::make_unique<s4tp_block>();
  EXPECT_EQ(s4tp_make_plan(fresh.get(), &input, &plan, &why), S4TP_NOT_INITIALIZED);
  EXPECT_EQ(s4tp_make_plan(nullptr, &input, &plan, &why), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_make_plan(block.get(), nullptr, &plan, &why), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(s4tp_make_plan(block.get(), &input, nullptr, &why), S4TP_INVALID_ARGUMENT);
  EXPECT_EQ(plan.start_ms, 77U);
  EXPECT_EQ(why.candidates, 99);
  EXPECT_EQ(s4tp_make_plan(block.get(), &input, &plan, nullptr), S4TP_OK);
}

// API-013: a copy of a planner is none; the original goes on.
TEST_F(CFacade, MovedBlockIsNotInitialized) {
  const auto copy = std::make_unique<s4tp_block>(*block);
  EXPECT_EQ(s4tp_make_plan(copy.get(), &input, &plan, &why), S4TP_NOT_INITIALIZED);
  EXPECT_EQ(plan_now(), S4TP_OK);
}

// API-010: refuses bad parameters by name, and then the earlier planner is gone too.
TEST_F(CFacade, InitNamesTheFirstBadParameter) {
  s4tp_parameters parameters;
  ASSERT_EQ(s4tp_default_parameters(&parameters), S4TP_OK);
  parameters.values[2] = kNaN;
  const char* bad = nullptr;
  EXPECT_EQ(s4tp_init(block.get(), &parameters, &bad), S4TP_INVALID_PARAMETER);
  EXPECT_STREQ(bad, parameter_info(2).name);
  EXPECT_EQ(plan_now(), S4TP_NOT_INITIALIZED);
  EXPECT_EQ(s4tp_init(block.get(), nullptr, &bad), S4TP_OK);
  EXPECT_EQ(bad, nullptr);
  EXPECT_EQ(s4tp_init(nullptr, nullptr, nullptr), S4TP_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace s4tp
