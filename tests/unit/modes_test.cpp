#include "firmware/ecu/modes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "firmware/ecu/supervision.hpp"

namespace s4tp::ecu {
namespace {

struct Row {
  TransitionId id;
  Mode from;
  Mode to;
  Situation situation;
};

Situation with(FaultBit fault) {
  Situation situation;
  situation.faults = bit(fault);
  situation.engage = true;
  situation.engage_released = false;
  return situation;
}

Situation healthy() {
  Situation situation;
  situation.version_known = true;
  situation.plan_at_hand = true;
  situation.engage = true;
  situation.engage_released = false;
  return situation;
}

/// One situation a row that makes it, and only it, apply.
std::vector<Row> rows() {
  Situation waiting = healthy();
  waiting.engage = false;
  waiting.engage_released = true;
  Situation no_plan = waiting;
  no_plan.plan_at_hand = false;
  Situation well = healthy();
  well.well = true;
  Situation resting = with(FaultBit::kMapLost);
  resting.at_rest = true;
  return {
      {TransitionId::kStandbyFault, Mode::kStandby, Mode::kFault, with(FaultBit::kSelfTest)},
      {TransitionId::kStandbyReady, Mode::kStandby, Mode::kReady, waiting},
      {TransitionId::kReadyFault, Mode::kReady, Mode::kFault, with(FaultBit::kSelfTest)},
      {TransitionId::kReadyStandby, Mode::kReady, Mode::kStandby, no_plan},
      {TransitionId::kReadyDriving, Mode::kReady, Mode::kDriving, healthy()},
      {TransitionId::kDrivingStandby, Mode::kDriving, Mode::kStandby, waiting},
      {TransitionId::kDrivingMinimumRisk, Mode::kDriving, Mode::kMinimumRisk, with(FaultBit::kMotionMissing)},
      {TransitionId::kDrivingDegraded, Mode::kDriving, Mode::kDegraded, with(FaultBit::kPlanLate)},
      {TransitionId::kDegradedStandby, Mode::kDegraded, Mode::kStandby, with(FaultBit::kDriverOverride)},
      {TransitionId::kDegradedMinimumRisk, Mode::kDegraded, Mode::kMinimumRisk, with(FaultBit::kTracksLost)},
      {TransitionId::kDegradedDriving, Mode::kDegraded, Mode::kDriving, well},
      {TransitionId::kMinimumRiskStandby, Mode::kMinimumRisk, Mode::kStandby,
       with(FaultBit::kDriverOverride)},
      {TransitionId::kMinimumRiskStopped, Mode::kMinimumRisk, Mode::kStopped, resting},
      {TransitionId::kStoppedFault, Mode::kStopped, Mode::kFault, with(FaultBit::kSelfTest)},
      {TransitionId::kStoppedStandby, Mode::kStopped, Mode::kStandby, waiting},
  };
}

// ECU-030 ECU-031 ECU-032 ECU-033 ECU-034 ECU-035 ECU-036 ECU-037 ECU-038 ECU-039 ECU-040 ECU-041 ECU-042
// ECU-043 ECU-044: each row of the table is taken in a situation of its own, and there are no other rows.
TEST(Modes, EveryRowOfTheTable) {
  std::set<TransitionId> reached;
  for (const Row& row : rows()) {
    const Transition* found = find_transition(row.from, row.situation);
    ASSERT_NE(found, nullptr) << static_cast<int>(row.id);
    EXPECT_EQ(found->id, row.id) << static_cast<int>(row.id);
    EXPECT_EQ(found->to, row.to) << static_cast<int>(row.id);
    reached.insert(found->id);
  }
  EXPECT_EQ(reached.size(), static_cast<std::size_t>(kTransitionCount));
  for (int i = 0; i < kTransitionCount; ++i) EXPECT_EQ(reached.count(transition(i).id), 1U);
}

// In a good situation every mode but Ready (engaged) and Standby stays what it is; Fault stays in any.
TEST(Modes, StaysWhenNothingApplies) {
  const Situation good = healthy();
  EXPECT_EQ(find_transition(Mode::kDriving, good), nullptr);
  EXPECT_EQ(find_transition(Mode::kDegraded, good), nullptr);
  EXPECT_EQ(find_transition(Mode::kMinimumRisk, good), nullptr);
  EXPECT_EQ(find_transition(Mode::kStopped, good), nullptr);
  for (Faults faults = 0; faults <= kAllFaults; ++faults) {
    Situation situation = good;
    situation.faults = faults;
    ASSERT_EQ(find_transition(Mode::kFault, situation), nullptr);
  }
}

// The driver comes first, then what ends the drive, then what degrades it.
TEST(Modes, Precedence) {
  Situation all = healthy();
  all.faults = kAllFaults;
  EXPECT_EQ(find_transition(Mode::kDriving, all)->to, Mode::kStandby);
  all.faults = kAllFaults & ~bit(FaultBit::kDriverOverride);
  EXPECT_EQ(find_transition(Mode::kDriving, all)->to, Mode::kMinimumRisk);
  all.faults = kDegradingFaults;
  EXPECT_EQ(find_transition(Mode::kDriving, all)->to, Mode::kDegraded);
}

// ECU-031: any single fault, an unknown version or no plan keeps the ECU in standby.
TEST(Modes, NothingMayBeMissingToGetReady) {
  EXPECT_EQ(find_transition(Mode::kStandby, healthy())->to, Mode::kReady);
  for (int i = 0; i < kFaultCount; ++i) {
    Situation situation = healthy();
    situation.faults = static_cast<Faults>(1U << i);
    const Transition* row = find_transition(Mode::kStandby, situation);
    EXPECT_TRUE(row == nullptr || row->to == Mode::kFault) << i;
  }
  Situation situation = healthy();
  situation.version_known = false;
  EXPECT_EQ(find_transition(Mode::kStandby, situation), nullptr);
}

// ECU-001 to ECU-007: only four modes may command.
TEST(Modes, WhoMayCommand) {
  for (const Mode mode : {Mode::kStandby, Mode::kReady, Mode::kFault}) EXPECT_FALSE(may_command(mode));
  for (const Mode mode : {Mode::kDriving, Mode::kDegraded, Mode::kMinimumRisk, Mode::kStopped}) {
    EXPECT_TRUE(may_command(mode));
  }
}

Observations all_well() {
  Observations observed;
  observed.motion_missing_ticks = 0;
  observed.pose_age_ms = observed.steering_age_ms = observed.tracks_age_ms = observed.map_age_ms = 0;
  observed.plan_age_ms = 0;
  return observed;
}

// ECU-010 ECU-011 ECU-012 ECU-013 ECU-014 ECU-015 ECU-016 ECU-017 ECU-020: there from the limit on, not
// before.
TEST(Supervision, LimitsToTheUnit) {
  struct Case {
    std::uint32_t Observations::*field;
    std::uint32_t limit;
    Faults faults;
  };
  const Faults tracks = static_cast<Faults>(bit(FaultBit::kTracksStale) | bit(FaultBit::kTracksLost));
  const Faults map = static_cast<Faults>(bit(FaultBit::kMapStale) | bit(FaultBit::kMapLost));
  const Case cases[] = {
      {&Observations::motion_missing_ticks, 3, bit(FaultBit::kMotionMissing)},
      {&Observations::motion_mistimed_ticks, 3, bit(FaultBit::kMotionTiming)},
      {&Observations::pose_age_ms, 100, bit(FaultBit::kPoseMissing)},
      {&Observations::steering_age_ms, 100, bit(FaultBit::kSteeringMissing)},
      {&Observations::tracks_age_ms, 250, bit(FaultBit::kTracksStale)},
      {&Observations::tracks_age_ms, 1000, tracks},
      {&Observations::map_age_ms, 1000, bit(FaultBit::kMapStale)},
      {&Observations::map_age_ms, 5000, map},
      {&Observations::plan_age_ms, 500, bit(FaultBit::kPlanLost)},
  };
  EXPECT_EQ(find_faults(all_well()), 0);
  for (const Case& c : cases) {
    Observations observed = all_well();
    observed.*c.field = c.limit;
    EXPECT_EQ(find_faults(observed), c.faults);
    observed.*c.field = c.limit - 1;
    EXPECT_NE(find_faults(observed), c.faults);
  }
}

// ECU-018 ECU-019 ECU-021 ECU-022 ECU-023 ECU-024 ECU-025: each observation its own bit; 1.5 m is still no
// fault.
TEST(Supervision, Flags) {
  const auto faults_with = [](auto change) {
    Observations observed = all_well();
    change(observed);
    return find_faults(observed);
  };
  EXPECT_EQ(faults_with([](Observations& o) { o.version_mismatch = true; }), bit(FaultBit::kVersionMismatch));
  EXPECT_EQ(faults_with([](Observations& o) { o.plan_late = true; }), bit(FaultBit::kPlanLate));
  EXPECT_EQ(faults_with([](Observations& o) { o.refused = true; }), bit(FaultBit::kSelfTest));
  EXPECT_EQ(faults_with([](Observations& o) { o.gate_denied = true; }), bit(FaultBit::kGateDenied));
  EXPECT_EQ(faults_with([](Observations& o) { o.driver_override = true; }), bit(FaultBit::kDriverOverride));
  EXPECT_EQ(faults_with([](Observations& o) { o.bus = hal::CanState::kBusOff; }), bit(FaultBit::kBusOff));
  EXPECT_EQ(faults_with([](Observations& o) { o.bus = hal::CanState::kDown; }), bit(FaultBit::kBusOff));
  EXPECT_EQ(faults_with([](Observations& o) { o.bus = hal::CanState::kPassive; }), 0);
  EXPECT_EQ(faults_with([](Observations& o) { o.plan_distance_m = 1.5F; }), 0);
  EXPECT_EQ(faults_with([](Observations& o) { o.plan_distance_m = 1.51F; }), bit(FaultBit::kTracking));
}

}  // namespace
}  // namespace s4tp::ecu
