// The C facade: an answer to everything that a caller in C may get wrong in an input.

#include <gtest/gtest.h>

#include <cstring>

#include "algo/api/s4tp.h"
#include "tests/support/c_facade.hpp"

namespace s4tp {
namespace {

using test::CFacade;
using test::kNaN;

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
  strange.points[3].heading_rad = 0.0F;
  strange.lane_change_side = 2;
  expect_invalid("side of the running plan's lane change");
  strange.lane_change_side = 0;
  strange.zone_claim = 5;
  expect_invalid("zone claim of the running plan");
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
  s4tp_plan empty = {};
  empty.start_ms = input.start_ms;
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

}  // namespace
}  // namespace s4tp
