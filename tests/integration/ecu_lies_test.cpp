/// The ECU on the bus while a sender lies: what becomes of the plans that are made of it.

#include <gtest/gtest.h>

#include "algo/core/math.hpp"
#include "tests/support/driving_rig.hpp"

namespace s4tp::ecu {
namespace {

/// Believes the wheels: goes on along their arc.
void go_where_the_wheels_point(const planner::PlannerInput& input, Plan& plan) {
  const EgoState& ego = input.ego;
  const float curvature_1pm = tan(ego.steering_rad) / 2.9F;
  const float way_m = ego.speed_mps * kStepS;  // and a step ahead is the start
  Pose pose = ego.rear_axle;
  for (TrajectoryPoint& point : plan.trajectory.points) {
    pose.heading_rad = wrap_angle(pose.heading_rad + curvature_1pm * way_m);
    pose = shift_ahead(pose, way_m);
    point.rear_axle = pose;
    point.speed_mps = ego.speed_mps;
    point.curvature_1pm = curvature_1pm;
  }
}

// ECU-100: straight on, the wheels are told to stand at 0.62 rad, from any tick between two boundaries on. The second such tick
// is a fault, and no plan takes effect any more, not in that tick either, though the planner goes on and would turn left. The
// vehicle stops straight ahead, along the plan before. Once the wheels are believed again, so are plans.
TEST(EcuLies, NoNewPlanTakesEffect) {
  for (int phase = 0; phase < 10; ++phase) {
    const auto rig = driving_rig();
    rig->ecu.planner().make = go_where_the_wheels_point;
    rig->ticks(20 + phase);
    rig->steering_told_rad = 0.62F;
    rig->tick();
    EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
    const std::size_t plans = rig->records.plans.size();
    const std::uint32_t kept_ms = rig->ecu.plan().start_ms;
    const int cycles = rig->ecu.planner().cycles;
    rig->tick();
    ASSERT_NE(rig->ecu.faults() & kLyingFaults, 0U);
    EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
    EXPECT_GT(rig->until(Mode::kStopped), 0);
    EXPECT_NE(rig->ecu.faults() & kLyingFaults, 0U);
    EXPECT_GT(rig->ecu.planner().cycles, cycles + 10);
    EXPECT_EQ(rig->records.plans.size(), plans) << "phase " << phase;
    EXPECT_EQ(rig->ecu.plan().start_ms, kept_ms);
    EXPECT_NEAR(rig->plant.y_m, 0.0, 0.01);

    rig->steering_told_rad.reset();
    rig->seconds(1.0);
    EXPECT_EQ(rig->ecu.faults() & kLyingFaults, 0U);
    EXPECT_GT(rig->records.plans.size(), plans);
  }
}

// PLAUS-011: a clock 4 % fast or slow is no fault, and the vehicle drives by it: a plan of 5 m/s, carried on, at 5.2 or 4.8 m/s.
TEST(EcuLies, ClockJustBelowItsLimitIsDrivenBy) {
  for (const int percent : {4, -4}) {
    const auto rig = driving_rig();
    rig->ecu.planner().make = plan_straight_on;
    const auto stamp_ms = [percent](int ticks) { return ticks * (1000 + 10 * percent) / 100; };
    for (int i = 0; i < 2000; ++i) {
      rig->interval_ms = static_cast<std::uint16_t>(stamp_ms(i + 1) - stamp_ms(i));
      rig->tick();
      ASSERT_EQ(rig->ecu.faults(), 0U) << percent << " %, tick " << i;
    }
    EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
    EXPECT_NEAR(rig->plant.speed_mps, 5.0 * (1.0 + 0.01 * percent), 0.02);
  }
}

}  // namespace
}  // namespace s4tp::ecu
