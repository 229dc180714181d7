// The ablation of the risk field: a margin, the same towards everybody.

#include "sim_host/baselines/constant_margin.hpp"

#include <gtest/gtest.h>

#include "tests/support/first_plan.hpp"
#include "tests/support/lane_maps.hpp"
#include "tests/support/scene_support.hpp"

namespace s4tp::baselines {
namespace {

/// How far the plan drives in 3 s: we at 10 m/s in the right of two lanes, a car stands 15 m ahead in the left one.
float way_m(float margin_m) {
  const LaneMap map = test::straight_road(2, 300.0F, 15.0F);
  Parameters parameters;
  parameters.safety.margin_m = margin_m;
  const Plan plan = test::first_plan<ConstantMarginPlanner<false>>(
      map, test::ego_at(50.0F, 0.0F, 0.0F, 10.0F), test::car(1, 65.0F, 3.2F, 0.0F, 0.0F), parameters);
  return plan.trajectory.points[kHorizonSteps].rear_axle.x_m - plan.trajectory.points[0].rear_axle.x_m;
}

}  // namespace

// Lanes of 3.2 m and cars of 1.8 m leave 1.4 m beside it: a margin of 0.3 m lets us pass (30 m at 10 m/s), one of 1.9 m
// keeps our front, 4 m before the rear axle, behind its rear at 62.5 m. (One further off may have set off before we are there.)
TEST(ConstantMargin, IsKeptFromWhoeverStandsBeside) {
  EXPECT_GT(way_m(0.3F), 28.0F);
  EXPECT_LT(way_m(1.9F), 8.5F);
}

}  // namespace s4tp::baselines
