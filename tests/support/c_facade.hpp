#pragma once
/// A planner behind the C facade, and an input of which it makes a plan.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "algo/api/s4tp.h"
#include "tests/support/c_map.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Entering a cross junction from the west to turn left, somebody comes from the east.
class CFacade : public testing::Test {
 protected:
  CFacade() {
    CrossJunction cross = cross_junction();
    set_route(cross, CrossJunction::kEast, CrossJunction::kLeft);
    core_map = cross.map;
    map = in_c(core_map);
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

}  // namespace s4tp::test
