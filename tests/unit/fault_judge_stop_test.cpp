// What the judge of fault scripts says of how the vehicle stops, drives again, and touches somebody.
#include "tests/support/judge_bench.hpp"

namespace s4tp::faults {
namespace {

using ecu::FaultBit;
using ecu::Mode;

// FAULT-012: a minimum-risk manoeuvre in which the car rolls on at 10 m/s is found when it should have lost
// speed; one that brakes with 3 m/s^2 and then stands is sound; moving off again is not.
TEST(FaultJudge, WatchesTheCarStop) {
  Bench rolls;
  EXPECT_EQ(rolls.ticks(20), Breach::kNone);
  rolls.mode = Mode::kMinimumRisk;
  rolls.faults = bit(FaultBit::kPoseMissing) | bit(FaultBit::kTracksLost);
  rolls.acceleration_mps2 = -4.0F;
  EXPECT_EQ(rolls.ticks(100), Breach::kNone);
  EXPECT_EQ(rolls.ticks(20), Breach::kUnsafeStop);

  Bench brakes;
  EXPECT_EQ(brakes.ticks(20), Breach::kNone);
  brakes.mode = Mode::kMinimumRisk;
  brakes.acceleration_mps2 = -4.0F;
  for (int i = 0; i < 600; ++i) {
    brakes.speed_mps = std::max(0.0, 10.0 - 0.03 * i);
    if (brakes.speed_mps <= 0.0) brakes.mode = Mode::kStopped;
    EXPECT_EQ(brakes.ticks(1), Breach::kNone) << brakes.judge.verdict().what;
  }
  brakes.speed_mps = 0.5;
  EXPECT_EQ(brakes.ticks(1), Breach::kUnsafeStop);
}

// FAULT-012: for want of lists it may drive on to its fail-safe's branch, 3 s at most, and then has its second of grace.
TEST(FaultJudge, LetsTheFailSafeComeToItsBranch) {
  Bench drives_on;
  drives_on.mode = Mode::kMinimumRisk;
  drives_on.faults = bit(FaultBit::kTracksLost);
  drives_on.acceleration_mps2 = 0.5F;
  EXPECT_EQ(drives_on.ticks(301), Breach::kNone);
  drives_on.acceleration_mps2 = -4.0F;
  EXPECT_EQ(drives_on.ticks(100), Breach::kNone);
  EXPECT_EQ(drives_on.ticks(10), Breach::kUnsafeStop);

  Bench never_brakes;
  never_brakes.mode = Mode::kMinimumRisk;
  never_brakes.faults = bit(FaultBit::kMapLost) | bit(FaultBit::kPlanLost);
  EXPECT_EQ(never_brakes.ticks(301), Breach::kNone);
  EXPECT_EQ(never_brakes.ticks(1), Breach::kLimits);
}

// FAULT-012: on its way to the branch, a status that says the pose is missing stands beside a command that brakes; the next one,
// with the pose back, need not. Once it says that the pose is implausible, all brake.
TEST(FaultJudge, TheFailSafeEndsWhereTheEgoIsInDoubt) {
  const auto breach = [](FaultBit doubt, float meanwhile_mps2, float later_mps2) {
    Bench bench;
    bench.mode = Mode::kMinimumRisk;
    bench.faults = bit(FaultBit::kTracksLost);
    EXPECT_EQ(bench.ticks(9), Breach::kNone);
    bench.faults = bench.faults | bit(doubt);
    bench.acceleration_mps2 = meanwhile_mps2;
    if (bench.ticks(10) != Breach::kNone) return bench.judge.verdict().breach;
    bench.faults = bit(FaultBit::kTracksLost);
    bench.acceleration_mps2 = later_mps2;
    return bench.ticks(20);
  };
  EXPECT_EQ(breach(FaultBit::kPoseMissing, -0.1F, 0.0F), Breach::kNone);
  EXPECT_EQ(breach(FaultBit::kPoseMissing, 0.0F, 0.0F), Breach::kLimits);
  EXPECT_EQ(breach(FaultBit::kPoseImplausible, -0.1F, 0.0F), Breach::kLimits);
  EXPECT_EQ(breach(FaultBit::kPoseImplausible, -0.1F, -0.1F), Breach::kNone);
}

// FAULT-013: degraded while faults last is sound; 250 ticks after the last one it is not.
TEST(FaultJudge, ExpectsRecovery) {
  Bench bench;
  bench.mode = Mode::kDegraded;
  EXPECT_EQ(bench.ticks(400), Breach::kNone);
  EXPECT_EQ(bench.judge.verdict().outcome, Outcome::kDegraded);
  bench.faulty = false;
  EXPECT_EQ(bench.ticks(kSettling - 1), Breach::kNone);
  EXPECT_EQ(bench.ticks(1), Breach::kNoRecovery);
}

// FAULT-018: a contact of our own fault is one, whatever the frames say.
TEST(FaultJudge, AContactIsAFailure) {
  Bench bench;
  bench.ticks(20);
  bench.judge.contact("we ran into another from behind");
  EXPECT_EQ(bench.judge.verdict().breach, Breach::kContact);
  EXPECT_EQ(bench.judge.verdict().what, "we ran into another from behind");
}

// FAULT-018: from 110 ms after its last command on the vehicle brakes by itself, and whom it touches then is counted beside; so it
// is in the stop that follows, until it drives again.
TEST(FaultJudge, WhoIsCutOffTouchesByNoFaultOfOurs) {
  const auto touches = [](int unheard_ticks, Mode mode, int later_ticks) {
    Bench bench;
    bench.ticks(20);
    for (int i = 0; i < unheard_ticks; ++i) {
      bench.begin();
      bench.judge.end_tick();
    }
    bench.mode = mode;
    bench.acceleration_mps2 = mode == Mode::kDriving ? 0.0F : -4.0F;
    bench.ticks(later_ticks);
    EXPECT_FALSE(bench.judge.breached()) << bench.judge.verdict().what;
    bench.judge.contact("changed lane into");
    return bench.judge.verdict().breach;
  };
  EXPECT_EQ(touches(10, Mode::kDriving, 0), Breach::kContact);
  EXPECT_EQ(touches(11, Mode::kDriving, 0), Breach::kNone);
  EXPECT_EQ(touches(11, Mode::kStopped, 20), Breach::kNone);
  EXPECT_EQ(touches(11, Mode::kDriving, 1), Breach::kContact);
}

}  // namespace
}  // namespace s4tp::faults
