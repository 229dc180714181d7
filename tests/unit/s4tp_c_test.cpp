// The C facade: same plans as the planner's own, and an answer to everything a caller in C may get wrong.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "algo/api/s4tp.h"
#include "algo/planner/planner.hpp"
#include "tests/support/c_map.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Entering a cross junction from the west to turn left, somebody comes from the east.
class CFacade : public testing::Test {
 protected:
  CFacade() {
    test::CrossJunction cross = test::cross_junction();
    test::set_route(cross, test::CrossJunction::kEast, test::CrossJunction::kLeft);
    core_map = cross.map;
    map = test::in_c(core_map);
    EXPECT_EQ(s4tp_init(block.get(), nullptr, nullptr), S4TP_OK);
    input.now_ms = 1000;
    input.start_ms = 1100;
    input.ego = {-30.0F, -1.6F, 0.0F, 8.0F, 0.0F, 0.0F, 0.0F};
    input.tracks = &tracks;
    input.map = &map;
    tracks.time_ms = 1000;
    tracks.count = 1;
    tracks.items[0] = {5, 40.0F, 1.6F, -3.14159F, 10.0F, 0.0F, 0.0F, 4.6F, 1.8F};
  }

  s4tp_status plan_now() { return s4tp_make_plan(block.get(), &input, &plan, &why); }

  /// The answer to an input that is not as documented, and what must then be there.
  void expect_invalid(const std::string& what) {
    EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT) << what;
    EXPECT_EQ(why.status, S4TP_INVALID_INPUT) << what;
    EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_MINIMUM_RISK)) << what;
    EXPECT_EQ(plan.start_ms, input.start_ms) << what;
    for (const s4tp_plan_point& point : plan.points) {
      EXPECT_TRUE(std::isfinite(point.x_m) && std::isfinite(point.speed_mps) && point.speed_mps >= 0.0F)
          << what;
    }
    EXPECT_LT(plan.points[S4TP_PLAN_POINTS - 1].speed_mps, 0.5F * plan.points[0].speed_mps + 0.01F) << what;
  }

  std::unique_ptr<s4tp_block> block = std::make_unique<s4tp_block>();
  LaneMap core_map;
  s4tp_lane_map map;
  s4tp_tracks tracks = {};
  s4tp_input input = {};
  s4tp_plan plan = {};
  s4tp_explanation why = {};
};

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

// API-012: whatever is wrong in map, list, running plan or own state, the answer is a plan that comes to
// rest.
TEST_F(CFacade, AnswersInvalidInputWithMinimumRisk) {
  const s4tp_lane_map good_map = map;
  const s4tp_tracks good_tracks = tracks;
  const s4tp_ego good_ego = input.ego;
  const auto with_map = [&](const char* what, auto change) {
    map = good_map;
    change(map);
    expect_invalid(what);
    map = good_map;
  };
  with_map("kind", [](s4tp_lane_map& m) { m.lanes[0].kind = 3; });
  with_map("one point", [](s4tp_lane_map& m) { m.lanes[0].point_count = 1; });
  with_map("thirteen points", [](s4tp_lane_map& m) { m.lanes[0].point_count = 13; });
  with_map("NaN point", [](s4tp_lane_map& m) { m.lanes[0].x_m[1] = kNaN; });
  with_map("far point", [](s4tp_lane_map& m) { m.lanes[0].y_m[0] = 2e5F; });
  with_map("width", [](s4tp_lane_map& m) { m.lanes[0].width_m = 0.0F; });
  with_map("limit", [](s4tp_lane_map& m) { m.lanes[0].speed_limit_mps = -1.0F; });
  with_map("stop line", [](s4tp_lane_map& m) { m.lanes[0].stop_line_m = kNaN; });
  with_map("link beyond the map", [](s4tp_lane_map& m) { m.lanes[0].left = S4TP_MAX_LANES; });
  with_map("link to a free slot", [](s4tp_lane_map& m) { m.lanes[0].successors[2] = S4TP_MAX_LANES - 1; });
  with_map("negative link", [](s4tp_lane_map& m) { m.lanes[0].right = -2; });
  with_map("conflict count", [](s4tp_lane_map& m) { m.conflict_count = S4TP_MAX_CONFLICTS + 1; });
  with_map("negative count", [](s4tp_lane_map& m) { m.conflict_count = -1; });
  with_map("negative number of lanes left out", [](s4tp_lane_map& m) { m.lanes_left_out = -1; });
  with_map("conflict of nobody", [](s4tp_lane_map& m) { m.conflicts[0].first = S4TP_NO_LANE_INDEX; });
  with_map("priority", [](s4tp_lane_map& m) { m.conflicts[0].priority = 3; });
  with_map("exit before entry", [](s4tp_lane_map& m) { m.conflicts[0].first_exit_m = -100.0F; });
  with_map("endless conflict", [](s4tp_lane_map& m) { m.conflicts[0].second_exit_m = 1e9F; });

  tracks.count = S4TP_MAX_TRACKS + 1;
  expect_invalid("too many vehicles");
  tracks.count = -1;
  expect_invalid("negative number of vehicles");
  tracks = good_tracks;
  tracks.left_out = -1;
  expect_invalid("negative number of vehicles left out");
  tracks = good_tracks;
  tracks.items[0].speed_mps = kNaN;
  expect_invalid("NaN vehicle");
  tracks = good_tracks;

  s4tp_plan strange = {};
  input.running = &strange;
  strange.kind = 3;
  expect_invalid("kind of the running plan");
  strange.kind = S4TP_PLAN_DRIVE;
  strange.points[30].curvature_1pm = kNaN;
  expect_invalid("NaN in the running plan");
  strange.points[30].curvature_1pm = 3.0F;
  expect_invalid("curvature of the running plan");
  strange.points[30].curvature_1pm = 0.0F;
  strange.points[3].heading_rad = 1e30F;
  expect_invalid("heading of the running plan");
  input.running = nullptr;

  input.start_ms = input.now_ms + 201;
  expect_invalid("start too late");
  input.start_ms = input.now_ms + 100;

  EXPECT_EQ(plan_now(), S4TP_OK);
  input.ego = good_ego;
  input.ego.speed_mps = -1.0F;
  EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
  EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_MINIMUM_RISK));
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

// API-016, CORE-013: 8 m/s at x = -30. A broken vehicle in the list: the stop begins where we are, 0.8 m on
// at the boundary. Our own state broken: at the running plan, or without one where we were seen last. Never
// seen: nothing, said so, all zeros.
TEST_F(CFacade, AStopBeginsWhereWeAreKnownToBe) {
  const s4tp_ego good_ego = input.ego;
  const auto stops_from = [this](float x_m) {
    EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
    EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_MINIMUM_RISK));
    EXPECT_NEAR(plan.points[0].x_m, x_m, 0.01F);
    EXPECT_NEAR(plan.points[0].y_m, -1.6F, 0.01F);
    EXPECT_NEAR(plan.points[0].speed_mps, 8.0F, 0.2F);
    EXPECT_EQ(plan.points[30].speed_mps, 0.0F);
  };
  input.ego.heading_rad = kNaN;
  plan.points[7].x_m = 5.0F;
  EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
  const s4tp_plan empty = {S4TP_PLAN_NONE, input.start_ms, 0.0F, 0.0F, {}};
  EXPECT_EQ(std::memcmp(&plan, &empty, sizeof(plan)), 0);

  input.ego = good_ego;
  tracks.items[0].length_m = kNaN;
  stops_from(-29.2F);
  input.ego.speed_mps = 99.0F;
  stops_from(-29.2F);

  tracks.items[0].length_m = 4.6F;
  input.ego = good_ego;
  s4tp_plan running = {};
  EXPECT_EQ(s4tp_make_plan(block.get(), &input, &running, nullptr), S4TP_OK);
  input.running = &running;
  input.ego.x_m = kNaN;
  input.now_ms += 1000;
  input.start_ms += 1000;
  EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
  EXPECT_EQ(plan.points[0].x_m, running.points[10].x_m);
  EXPECT_EQ(plan.points[0].speed_mps, running.points[10].speed_mps);

  EXPECT_EQ(s4tp_init(block.get(), nullptr, nullptr), S4TP_OK);
  input.running = nullptr;
  EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
  EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_NONE)) << "init forgets";
}

// API-012, API-016: a running plan with a fail-safe of 10^28 m/s^2 is invalid, and so is that braking: the stop
// brakes as a stop of its own.
TEST_F(CFacade, AFailSafeOfAnInvalidPlanIsNotDriven) {
  s4tp_plan running = {};
  EXPECT_EQ(s4tp_make_plan(block.get(), &input, &running, nullptr), S4TP_OK);
  input.running = &running;
  for (const float braking_mps2 : {1e28F, -1.0F, kNaN}) {
    running.fail_safe_braking_mps2 = braking_mps2;
    EXPECT_EQ(plan_now(), S4TP_INVALID_INPUT);
    EXPECT_EQ(plan.kind, static_cast<std::uint32_t>(S4TP_PLAN_MINIMUM_RISK));
    EXPECT_GT(plan.fail_safe_braking_mps2, 0.0F);
    EXPECT_LE(plan.fail_safe_braking_mps2, 13.0F);
    EXPECT_GT(plan.points[1].speed_mps, 7.0F) << "8 m/s, a tenth of a second later";
  }
  input.running = nullptr;
}

// CORE-008, API-012: a list that is thrown away for its time never answers OK, and the plan is a stop: over
// 500 ms old, as far ahead, time 0, older than the one before. One cycle later with a fresh list it drives
// on.
TEST_F(CFacade, AListThrownAwayIsAStop) {
  input.now_ms = 100'000;
  const auto cycle = [this](std::uint32_t list_ms) {
    input.start_ms = input.now_ms + 100U;
    tracks.time_ms = list_ms;
    const s4tp_status status = plan_now();
    const bool stop = plan.kind == S4TP_PLAN_MINIMUM_RISK && plan.points[30].speed_mps < 0.1F;
    EXPECT_EQ(status == S4TP_OK, !stop) << list_ms;
    EXPECT_EQ(why.status, status);
    input.now_ms += 100U;
    return status;
  };
  EXPECT_EQ(cycle(input.now_ms - 500U), S4TP_OK);
  EXPECT_EQ(cycle(input.now_ms - 501U), S4TP_STALE_TRACKS);
  EXPECT_EQ(cycle(input.now_ms + 501U), S4TP_STALE_TRACKS);
  EXPECT_EQ(cycle(0), S4TP_STALE_TRACKS);
  EXPECT_EQ(cycle(input.now_ms), S4TP_OK);
  EXPECT_EQ(cycle(input.now_ms - 150U), S4TP_STALE_TRACKS) << "older than the one before";
  const std::uint32_t frozen_ms = input.now_ms;
  for (int i = 0; i <= 5; ++i) EXPECT_EQ(cycle(frozen_ms), S4TP_OK) << i;
  EXPECT_EQ(cycle(frozen_ms), S4TP_STALE_TRACKS);
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
