/// The ECU on the bus: every mode reached, and left again, by real frames.

#include <gtest/gtest.h>

#include "tests/support/driving_rig.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

// ECU-001 ECU-002 ECU-003: standby until all is whole (the second VERSION frame is the first trusted one, at
// 1.07 s), then ready; engaged, driving in the same tick. Status and command frames say so.
TEST(EcuModes, FromStandbyToDriving) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.tick();
  EXPECT_EQ(rig.ecu.mode(), Mode::kStandby);
  EXPECT_EQ(rig.command.mode, static_cast<int>(Mode::kStandby));
  EXPECT_EQ(rig.until(Mode::kReady), 106);
  EXPECT_EQ(rig.ecu.faults(), 0);
  rig.seconds(1.0);
  EXPECT_EQ(rig.ecu.mode(), Mode::kReady);
  rig.engage = true;
  rig.tick();
  EXPECT_EQ(rig.ecu.mode(), Mode::kDriving);
  EXPECT_EQ(rig.command.mode, static_cast<int>(Mode::kDriving));
  rig.ticks(10);
  ASSERT_TRUE(rig.status.has_value());
  EXPECT_EQ(rig.status->mode, static_cast<int>(Mode::kDriving));
  EXPECT_EQ(rig.status->faults, 0);
  EXPECT_EQ(rig.status->plan_kind, static_cast<int>(PlanKind::kDrive));
  EXPECT_LE(rig.status->plan_age_10ms, 10);
}

// ECU-007 ECU-021 ECU-030 ECU-078: a refused self-test leads to the fault mode, which says so and drives
// nothing.
TEST(EcuModes, RefusalAtStart) {
  Rig rig;
  rig.ecu.planner().init_answer = Status::kArithmetic;
  EXPECT_EQ(rig.start(), Status::kArithmetic);
  rig.engage = true;
  rig.seconds(3.0);
  EXPECT_EQ(rig.ecu.mode(), Mode::kFault);
  EXPECT_TRUE(rig.fault(FaultBit::kSelfTest));
  EXPECT_EQ(rig.command.mode, static_cast<int>(Mode::kFault));
  EXPECT_EQ(rig.command.acceleration_mps2, -3.0F);
  EXPECT_TRUE(took(rig, TransitionId::kStandbyFault));
}

// Without a bus, a cycle counter or a watchdog there is nothing to stand on.
TEST(EcuModes, RefusesMissingPorts) {
  Rig rig;
  EXPECT_EQ(rig.ecu.init({}, {nullptr, &rig.cycles, &rig.watchdog, nullptr}), Status::kInvalidInput);
  EXPECT_EQ(rig.ecu.init({}, {rig.ecu_port, nullptr, &rig.watchdog, nullptr}), Status::kInvalidInput);
  EXPECT_EQ(rig.ecu.init({}, {rig.ecu_port, &rig.cycles, nullptr, nullptr}), Status::kInvalidInput);
}

// ECU-032 ECU-021: a planner that refuses while waiting ends in fault.
TEST(EcuModes, RefusalWhenReady) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  ASSERT_GE(rig.until(Mode::kReady), 0);
  rig.ecu.planner().plan_answer = Status::kNotInitialized;
  EXPECT_GE(rig.until(Mode::kFault, 30), 0);
  EXPECT_TRUE(took(rig, TransitionId::kReadyFault));
}

// ECU-043 ECU-036: one that refuses while driving stops the car first.
TEST(EcuModes, RefusalWhileDriving) {
  const auto rig = driving_rig();
  rig->ecu.planner().plan_answer = Status::kNotInitialized;
  EXPECT_GE(rig->until(Mode::kStopped, 600), 0);
  EXPECT_EQ(rig->plant.speed_mps, 0.0);
  EXPECT_GE(rig->until(Mode::kFault, 5), 0);
  EXPECT_TRUE(took(*rig, TransitionId::kDrivingMinimumRisk));
  EXPECT_TRUE(took(*rig, TransitionId::kStoppedFault));
}

// ECU-033: an input gone while ready leads back to standby, and its return to ready.
TEST(EcuModes, ReadyAndBack) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  ASSERT_GE(rig.until(Mode::kReady), 0);
  rig.pose = false;
  EXPECT_GE(rig.until(Mode::kStandby, 15), 0);
  EXPECT_TRUE(took(rig, TransitionId::kReadyStandby));
  rig.pose = true;
  EXPECT_GE(rig.until(Mode::kReady, 30), 0);
}

// ECU-031: half a second without motion frames, in which plans are made from dead reckoning; ready, and
// driving, only once the plan in force was asked for (100 ms before its start) with everything whole again.
TEST(EcuModes, DrivesNoPlanMadeBlind) {
  for (int phase = 0; phase < 10; ++phase) {
    Rig rig;
    ASSERT_EQ(rig.start(), Status::kOk);
    rig.plant.speed_mps = 5.0;
    ASSERT_GE(rig.until(Mode::kReady), 0);
    rig.motion = false;
    rig.ticks(50 + phase);
    rig.engage = true;
    rig.motion = true;
    while (rig.ecu.faults() != 0 && rig.number < 1000) rig.tick();
    const std::uint32_t whole_ms = rig.ecu.core().now_ms();
    ASSERT_GE(rig.until(Mode::kDriving, 40), 0);
    EXPECT_GE(rig.ecu.plan().start_ms - 100U, whole_ms) << phase;
  }
}

// ECU-035: the driver switches off.
TEST(EcuModes, EngageReleased) {
  const auto rig = driving_rig();
  rig->engage = false;
  rig->tick();
  EXPECT_EQ(rig->ecu.mode(), Mode::kStandby);
}

// ECU-005 ECU-006 ECU-042 ECU-044: with the map gone the car brakes at 4 m/s^2 to rest, 5^2 / 8 = 3.1 m and
// the brake's lag further on, is held there, and is free again when the switch is off.
TEST(EcuModes, MinimumRiskToStandby) {
  const auto rig = driving_rig();
  rig->layout_hash ^= 1U;
  ASSERT_GE(rig->until(Mode::kMinimumRisk, 210), 0);
  const double from_m = rig->plant.x_m;
  ASSERT_GE(rig->until(Mode::kStopped, 200), 0);
  EXPECT_NEAR(rig->plant.x_m - from_m, 3.1 + 5.0 * 0.16, 0.4);
  rig->seconds(2.0);
  EXPECT_EQ(rig->ecu.mode(), Mode::kStopped);
  EXPECT_EQ(rig->plant.speed_mps, 0.0);
  EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -4.0F);
  rig->engage = false;
  rig->tick();
  EXPECT_EQ(rig->ecu.mode(), Mode::kStandby);
  EXPECT_TRUE(took(*rig, TransitionId::kMinimumRiskStopped));
  EXPECT_TRUE(took(*rig, TransitionId::kStoppedStandby));
}

}  // namespace
}  // namespace s4tp::ecu
