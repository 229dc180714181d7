/// The ECU on the bus: how a minimum-risk manoeuvre is driven, and which plans take effect in it.

#include <gtest/gtest.h>

#include "tests/support/driving_rig.hpp"

namespace s4tp::ecu {
namespace {

/// Straight on at 5 m/s, with a fail-safe that leaves off driving after 1.5 s.
void drive_straight_on(const planner::PlannerInput& input, Plan& plan) {
  plan_straight_on(input, plan);
  plan.fail_safe = {1.5F, 6.0F};
}

std::unique_ptr<Rig> straight_on_rig() {
  auto rig = driving_rig();
  rig->ecu.planner().make = drive_straight_on;
  rig->seconds(0.5);
  return rig;
}

/// Milliseconds into the plan in force.
std::int32_t into_plan_ms(const Rig& rig) {
  return static_cast<std::int32_t>(rig.ecu.core().now_ms() - rig.ecu.plan().start_ms);
}

// ECU-105 ECU-106: the planner falls silent, or the lists or the map stop. The fail-safe of the plan in force is driven on with to
// 1.5 s after its start, then braked with 6 m/s^2.
TEST(EcuMinimumRisk, DrivesTheFailSafeInForce) {
  for (bool Rig::*lost : {&Rig::run_planner, &Rig::tracks, &Rig::map}) {
    const auto rig = straight_on_rig();
    rig.get()->*lost = false;
    ASSERT_GE(rig->until(Mode::kMinimumRisk, 700), 0);
    while (into_plan_ms(*rig) < 1490) {
      rig->tick();
      ASSERT_GT(rig->command.acceleration_mps2, -1.0F) << into_plan_ms(*rig);
    }
    EXPECT_NEAR(rig->plant.speed_mps, 5.0, 0.1);
    rig->tick();
    EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -6.0F);
    EXPECT_GE(rig->until(Mode::kStopped, 120), 0);
  }
}

// ECU-105: before the branch the pose is lost too. While it is, the vehicle is braked; then the fail-safe is gone on with.
TEST(EcuMinimumRisk, BrakesWhileThePoseIsMissing) {
  const auto rig = straight_on_rig();
  rig->run_planner = false;
  ASSERT_GE(rig->until(Mode::kMinimumRisk, 100), 0);
  EXPECT_GT(rig->command.acceleration_mps2, -1.0F);
  rig->pose = false;
  while (!rig->fault(FaultBit::kPoseMissing)) rig->tick();
  EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -6.0F);
  rig->ticks(5);
  EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -6.0F);
  rig->pose = true;
  rig->ticks(45);
  ASSERT_LT(into_plan_ms(*rig), 1400);
  EXPECT_GT(rig->command.acceleration_mps2, -1.0F);
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
}

// ECU-105: before the branch a steering angle is told that cannot be. From then on it is braked, and still is when the angle is
// believed again.
TEST(EcuMinimumRisk, BrakesForGoodOnceItselfIsInDoubt) {
  const auto rig = straight_on_rig();
  rig->run_planner = false;
  ASSERT_GE(rig->until(Mode::kMinimumRisk, 100), 0);
  rig->steering_told_rad = 0.62F;
  rig->ticks(4);
  ASSERT_NE(rig->ecu.faults() & kLyingFaults, 0U);
  rig->steering_told_rad.reset();
  for (int i = 0; i < 60; ++i) {
    EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -6.0F);
    rig->tick();
  }
  ASSERT_LT(into_plan_ms(*rig), 1400);
}

// ECU-107: once lists were lost, the planner's plans to drive on change nothing, though it makes one a cycle and lists are back:
// the vehicle comes to rest. The stops it plans take effect; those of a vehicle that is braked at once do not.
TEST(EcuMinimumRisk, TakesStopsOnly) {
  const auto rig = straight_on_rig();
  rig->tracks = false;
  ASSERT_GE(rig->until(Mode::kMinimumRisk, 150), 0);
  rig->tracks = true;
  const std::size_t plans = rig->records.plans.size();
  rig->ticks(60);
  EXPECT_FALSE(rig->fault(FaultBit::kTracksLost));
  EXPECT_TRUE(rig->ecu.planner().had_running);
  EXPECT_EQ(rig->records.plans.size(), plans);

  rig->ecu.planner().make = [](const planner::PlannerInput& input, Plan& plan) {
    drive_straight_on(input, plan);
    plan.kind = PlanKind::kMinimumRisk;
    plan.fail_safe = {0.0F, 7.0F};
  };
  rig->ticks(20);
  EXPECT_GT(rig->records.plans.size(), plans);
  EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -7.0F);

  rig->pose = false;
  while (!rig->fault(FaultBit::kPoseMissing)) rig->tick();
  const std::size_t stops = rig->records.plans.size();
  EXPECT_GE(rig->until(Mode::kStopped, 200), 0);
  EXPECT_EQ(rig->records.plans.size(), stops);
}

}  // namespace
}  // namespace s4tp::ecu
