/// The ECU on the bus: every fault bit reached, and left again, by real frames.

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/driving_rig.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

// ECU-010: two ticks without a motion frame are none; at the third the car stops safely. The frames' return
// clears the bit but not the mode.
TEST(EcuFaults, MotionMissing) {
  const auto rig = driving_rig();
  rig->motion = false;
  rig->ticks(2);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  rig->tick();
  EXPECT_TRUE(rig->fault(FaultBit::kMotionMissing));
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  EXPECT_FLOAT_EQ(rig->command.acceleration_mps2, -4.0F);
  rig->motion = true;
  rig->ticks(6);
  EXPECT_FALSE(rig->fault(FaultBit::kMotionMissing));
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
}

// A tick without a motion frame still sends a command, and vehicle time goes on: 20 ticks are 200 ms.
TEST(EcuFaults, ControlRunsWithoutMotion) {
  const auto rig = driving_rig();
  const std::uint32_t before_ms = rig->ecu.core().now_ms();
  rig->motion = false;
  for (int i = 0; i < 20; ++i) {
    rig->command.tick = 0;
    rig->tick();
    EXPECT_EQ(rig->command.tick, rig->number & 0xFFF);
  }
  EXPECT_EQ(rig->ecu.core().now_ms(), before_ms + 200);
}

// ECU-011 ECU-004: intervals of 13 ms (late) or 7 ms (early) for 3 ticks degrade; 8 and 12 ms do not; the
// first good one clears the bit, and a second without faults the mode (ECU-026).
TEST(EcuFaults, MotionTiming) {
  for (const std::uint16_t interval_ms : {7, 13}) {
    const auto rig = driving_rig();
    rig->interval_ms = interval_ms;
    rig->ticks(2);
    EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
    rig->tick();
    EXPECT_TRUE(rig->fault(FaultBit::kMotionTiming)) << interval_ms;
    EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
    rig->interval_ms = 10;
    rig->tick();
    EXPECT_FALSE(rig->fault(FaultBit::kMotionTiming));
    rig->ticks(98);
    EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
    rig->ticks(1);
    EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
    EXPECT_TRUE(took(*rig, TransitionId::kDegradedDriving));
  }
  for (const std::uint16_t interval_ms : {8, 12}) {
    const auto rig = driving_rig();
    rig->interval_ms = interval_ms;
    rig->ticks(10);
    EXPECT_FALSE(rig->fault(FaultBit::kMotionTiming)) << interval_ms;
  }
}

/// Ticks until the bit is set after `change`, at most `limit`.
int ticks_until(Rig& rig, FaultBit fault, int limit) {
  for (int i = 1; i <= limit; ++i) {
    rig.tick();
    if (rig.fault(fault)) return i;
  }
  return -1;
}

// ECU-012: the last pose came at an even tick; 100 ms later it is missing, and the car stops. A trusted pose
// clears the bit.
TEST(EcuFaults, PoseMissing) {
  const auto rig = driving_rig();
  while (rig->number % 2 != 0) rig->tick();
  rig->pose = false;
  EXPECT_EQ(ticks_until(*rig, FaultBit::kPoseMissing, 20), 10);
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  rig->pose = true;
  rig->ticks(10);
  EXPECT_FALSE(rig->fault(FaultBit::kPoseMissing));
}

// ECU-013: the driver's switches unseen for 100 ms.
TEST(EcuFaults, SteeringMissing) {
  const auto rig = driving_rig();
  rig->steering = false;
  EXPECT_EQ(ticks_until(*rig, FaultBit::kSteeringMissing, 20), 10);
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  rig->steering = true;
  rig->ticks(6);
  EXPECT_FALSE(rig->fault(FaultBit::kSteeringMissing));
}

// ECU-014 ECU-015 ECU-004 ECU-039: the last list arrived with number % 10 == 4. 250 ms later two are missing: degraded,
// and the planner is told; 1000 ms later lost: stopping.
TEST(EcuFaults, TracksStaleAndLost) {
  const auto rig = driving_rig();
  while (rig->number % 10 != 4) rig->tick();
  rig->tracks = false;
  EXPECT_EQ(ticks_until(*rig, FaultBit::kTracksStale, 40), 25);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
  EXPECT_EQ(rig->ecu.planner().seen.degraded, 0);
  rig->ticks(10);
  EXPECT_EQ(rig->ecu.planner().seen.degraded, 1);
  EXPECT_EQ(ticks_until(*rig, FaultBit::kTracksLost, 100), 65);
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  EXPECT_TRUE(took(*rig, TransitionId::kDegradedMinimumRisk));
  rig->tracks = true;
  rig->seconds(0.6);
  EXPECT_FALSE(rig->fault(FaultBit::kTracksStale));
  EXPECT_FALSE(rig->fault(FaultBit::kTracksLost));
}

// ECU-016 ECU-017: unconfirmed for 1 s degrades, for 5 s stops; the planner then has no map. Its return
// clears.
TEST(EcuFaults, MapStaleAndLost) {
  const auto rig = driving_rig();
  rig->map = false;
  const int stale = ticks_until(*rig, FaultBit::kMapStale, 120);
  EXPECT_GE(stale, 90);
  EXPECT_LE(stale, 100);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
  EXPECT_EQ(ticks_until(*rig, FaultBit::kMapLost, 500), 400);
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  rig->ticks(20);
  EXPECT_FALSE(rig->ecu.planner().had_map);
  rig->map = true;
  rig->seconds(1.0);
  EXPECT_FALSE(rig->fault(FaultBit::kMapStale));
  EXPECT_FALSE(rig->fault(FaultBit::kMapLost));
  EXPECT_TRUE(rig->ecu.planner().had_map);
}

// ECU-018: another layout hash keeps the ECU in standby; the right one clears the bit.
TEST(EcuFaults, VersionMismatch) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.layout_hash ^= 1U;
  rig.seconds(4.0);
  EXPECT_TRUE(rig.fault(FaultBit::kVersionMismatch));
  EXPECT_EQ(rig.ecu.mode(), Mode::kStandby);
  rig.layout_hash ^= 1U;
  rig.seconds(1.1);
  EXPECT_FALSE(rig.fault(FaultBit::kVersionMismatch));
  EXPECT_EQ(rig.ecu.mode(), Mode::kReady);
}

// ECU-019 ECU-076: one miss: the old plan stays, the status counts it, the mode is degraded for the 200 ms
// without a plan in time and 1 s more; then driving again.
TEST(EcuFaults, PlanLate) {
  const auto rig = driving_rig();
  const std::uint32_t start_ms = rig->ecu.plan().start_ms;
  while (rig->ecu.plan().start_ms == start_ms) rig->tick();
  const std::uint32_t kept_ms = rig->ecu.plan().start_ms;
  rig->ecu.inject_deadline_miss();
  rig->ticks(10);
  EXPECT_TRUE(rig->fault(FaultBit::kPlanLate));
  EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
  EXPECT_EQ(rig->ecu.plan().start_ms, kept_ms);
  rig->ticks(20);
  EXPECT_FALSE(rig->fault(FaultBit::kPlanLate));
  EXPECT_EQ(rig->ecu.plan().start_ms, kept_ms + 300);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDegraded);
  rig->seconds(1.0);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  EXPECT_EQ(rig->status->deadline_misses, 1);
}

// ECU-020: a planner that never comes back: late at once, lost 500 ms after the last plan took effect, then
// the ECU stops by itself along the last plan. Its return clears both bits.
TEST(EcuFaults, PlanLost) {
  const auto rig = driving_rig();
  while (rig->ecu.core().now_ms() % 100 != 0) rig->tick();
  rig->run_planner = false;
  rig->ticks(59);
  EXPECT_FALSE(rig->fault(FaultBit::kPlanLost));
  EXPECT_TRUE(rig->fault(FaultBit::kPlanLate));
  rig->tick();
  EXPECT_TRUE(rig->fault(FaultBit::kPlanLost));
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  EXPECT_GE(rig->until(Mode::kStopped, 300), 0);
  EXPECT_EQ(rig->plant.speed_mps, 0.0);
  rig->run_planner = true;
  rig->ticks(35);
  EXPECT_FALSE(rig->fault(FaultBit::kPlanLost));
  EXPECT_FALSE(rig->fault(FaultBit::kPlanLate));
}

// ECU-020: plans that are none, or hold a NaN, never take effect.
TEST(EcuFaults, PlansThatAreNone) {
  for (const bool broken : {false, true}) {
    const auto rig = driving_rig();
    rig->ecu.planner().make = [broken](const planner::PlannerInput&, Plan& plan) {
      if (broken) {
        plan.trajectory.points[17].curvature_1pm = std::numeric_limits<float>::quiet_NaN();
      } else {
        plan.kind = PlanKind::kNone;
      }
    };
    EXPECT_GE(rig->until(Mode::kMinimumRisk, 70), 0);
    EXPECT_TRUE(rig->fault(FaultBit::kPlanLost));
    EXPECT_FALSE(rig->fault(FaultBit::kPlanLate));
  }
}

// A minimum-risk plan is driven like any other: no change of mode (status kNoSafePlan).
TEST(EcuFaults, NoSafePlanIsDriven) {
  const auto rig = driving_rig();
  rig->ecu.planner().plan_answer = Status::kNoSafePlan;
  rig->ecu.planner().make = [](const planner::PlannerInput& input, Plan& plan) {
    plan.kind = PlanKind::kMinimumRisk;
    for (TrajectoryPoint& point : plan.trajectory.points) {
      point.rear_axle = input.ego.rear_axle;
      point.speed_mps = input.ego.speed_mps;
    }
  };
  rig->ticks(20);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  EXPECT_EQ(rig->ecu.plan().kind, PlanKind::kMinimumRisk);
  EXPECT_EQ(rig->status->planner_status, static_cast<int>(Status::kNoSafePlan));
}

// ECU-022: the bus off: the car is told nothing, the mode is stopping; back on, the bit clears.
TEST(EcuFaults, BusOff) {
  const auto rig = driving_rig();
  rig->ecu_port->set_state(hal::CanState::kBusOff);
  rig->tick();
  EXPECT_TRUE(rig->fault(FaultBit::kBusOff));
  EXPECT_EQ(rig->ecu.mode(), Mode::kMinimumRisk);
  EXPECT_TRUE(rig->from_ecu.empty());
  rig->ecu_port->set_state(hal::CanState::kActive);
  rig->ticks(2);
  EXPECT_FALSE(rig->fault(FaultBit::kBusOff));
}

// ECU-023: the car is moved 2 m sideways: tracking has failed, the ECU stops it where it is.
TEST(EcuFaults, Tracking) {
  const auto rig = driving_rig();
  rig->plant.y_m += 2.0;
  EXPECT_GT(ticks_until(*rig, FaultBit::kTracking, 4), 0);
  EXPECT_GE(rig->until(Mode::kMinimumRisk, 2), 0);
  rig->tick();
  EXPECT_FALSE(rig->fault(FaultBit::kTracking));
}

// ECU-024: eleven ticks without motion: the gate no longer believes its speed. It does when the frames
// return.
TEST(EcuFaults, GateDenied) {
  const auto rig = driving_rig();
  rig->motion = false;
  EXPECT_EQ(ticks_until(*rig, FaultBit::kGateDenied, 20), 12);
  rig->motion = true;
  rig->ticks(6);
  EXPECT_FALSE(rig->fault(FaultBit::kGateDenied));
}

// ECU-025 ECU-035 ECU-038 ECU-041: the driver takes over from any driving mode at once. The engage switch,
// still on, counts only after it has been off.
TEST(EcuFaults, DriverOverride) {
  const auto rig = driving_rig();
  rig->driver_override = true;
  rig->tick();
  EXPECT_TRUE(rig->fault(FaultBit::kDriverOverride));
  EXPECT_EQ(rig->ecu.mode(), Mode::kStandby);
  EXPECT_TRUE(took(*rig, TransitionId::kDrivingStandby));
  rig->driver_override = false;
  rig->seconds(1.0);
  EXPECT_FALSE(rig->fault(FaultBit::kDriverOverride));
  EXPECT_EQ(rig->ecu.mode(), Mode::kReady);
  rig->engage = false;
  rig->ticks(2);
  rig->engage = true;
  rig->tick();
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);

  rig->ecu.inject_deadline_miss();
  ASSERT_GE(rig->until(Mode::kDegraded, 15), 0);
  rig->driver_override = true;
  rig->tick();
  EXPECT_EQ(rig->ecu.mode(), Mode::kStandby);
  EXPECT_TRUE(took(*rig, TransitionId::kDegradedStandby));

  rig->driver_override = false;
  ASSERT_TRUE(rig->drive());
  rig->pose = false;
  ASSERT_GE(rig->until(Mode::kMinimumRisk, 15), 0);
  rig->driver_override = true;
  rig->tick();
  EXPECT_EQ(rig->ecu.mode(), Mode::kStandby);
  EXPECT_TRUE(took(*rig, TransitionId::kMinimumRiskStandby));
}

}  // namespace
}  // namespace s4tp::ecu
