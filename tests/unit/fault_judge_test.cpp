#include <gtest/gtest.h>

#include "firmware/wire/e2e.hpp"
#include "sim_host/faults/judge.hpp"
#include "tests/support/sealed_frames.hpp"

namespace s4tp::faults {
namespace {

using ecu::FaultBit;
using ecu::Mode;
using wire::Frame;

constexpr int kSettling = 250;

/// An ECU made of nothing but frames, in front of a judge.
class Bench {
 public:
  Judge judge{kSettling};
  Mode mode = Mode::kDriving;
  ecu::Faults faults = 0;  ///< as its status says
  float acceleration_mps2 = 0.0F;
  float steering_rad = 0.0F;
  double speed_mps = 10.0;  ///< true, and told
  bool motion = true;
  bool status = true;
  bool faulty = true;  ///< the script is not over
  int number = 0;

  /// The frames of one tick.
  std::vector<Frame> frames() {
    std::vector<Frame> sent;
    if (status && number % 10 == 0) {
      wire::EcuStatus message;
      message.mode = static_cast<std::uint8_t>(mode);
      message.faults = faults;
      sent.push_back(test::sealed(message, status_sender_));
    }
    wire::Command command;
    command.acceleration_mps2 = acceleration_mps2;
    command.steering_rad = steering_rad;
    command.mode = static_cast<std::uint8_t>(mode);
    command.accepted = static_cast<std::uint16_t>(accepted_ & 0xFFF);
    sent.push_back(test::sealed(command, command_sender_));
    return sent;
  }

  void begin() {
    judge.begin_tick(++number, speed_mps, !faulty);
    if (!motion) return;
    wire::Motion message;
    message.speed_mps = static_cast<float>(speed_mps);
    take(test::sealed(message, motion_sender_));
  }

  void take(const Frame& frame) {
    judge.taken(frame);
    ++accepted_;
  }

  Breach ticks(int count) {
    for (int i = 0; i < count; ++i) {
      begin();
      judge.control_tick(frames(), false);
      judge.end_tick();
    }
    return judge.verdict().breach;
  }

 private:
  int accepted_ = 0;
  wire::E2eSender motion_sender_;
  wire::E2eSender status_sender_;
  wire::E2eSender command_sender_;
};

/// Breach after `before` good ticks and one more with what `spoil` did.
template <class Spoil>
Verdict spoiled(const Spoil& spoil, Bench bench = {}) {
  EXPECT_EQ(bench.ticks(20), Breach::kNone) << bench.judge.verdict().what;
  spoil(bench);
  (void)bench.ticks(1);
  return bench.judge.verdict();
}

// A sound drive is judged sound, for 15 s.
TEST(FaultJudge, AcceptsASoundDrive) {
  Bench bench;
  bench.faulty = false;
  EXPECT_EQ(bench.ticks(1500), Breach::kNone) << bench.judge.verdict().what;
  EXPECT_EQ(bench.judge.verdict().outcome, Outcome::kDrive);
}

// FAULT-010: a tick with no command, two, one that is not the last, one with a wrong CRC or an old counter.
TEST(FaultJudge, HearsSilence) {
  const auto breach = [](const auto& change) {
    Bench bench;
    EXPECT_EQ(bench.ticks(20), Breach::kNone);
    bench.begin();
    std::vector<Frame> sent = bench.frames();
    change(sent);
    bench.judge.control_tick(sent, false);
    return bench.judge.verdict().breach;
  };
  EXPECT_EQ(breach([](std::vector<Frame>&) {}), Breach::kNone);
  EXPECT_EQ(breach([](std::vector<Frame>& sent) { sent.clear(); }), Breach::kSilence);
  EXPECT_EQ(breach([](std::vector<Frame>& sent) { sent.push_back(sent.back()); }), Breach::kSilence);
  EXPECT_EQ(breach([](std::vector<Frame>& sent) { sent.push_back({0x33, 8, {}}); }), Breach::kSilence);
  EXPECT_EQ(breach([](std::vector<Frame>& sent) { sent.back().data[3] ^= 1U; }), Breach::kSilence);
  EXPECT_EQ(breach([](std::vector<Frame>& sent) {
              sent.back().data[1] = static_cast<std::uint8_t>((sent.back().data[1] & 0xF0U) | 3U);
              wire::e2e_seal(sent.back());
            }),
            Breach::kSilence);
  Bench mute;
  EXPECT_EQ(mute.ticks(20), Breach::kNone);
  mute.status = false;
  EXPECT_EQ(mute.ticks(11), Breach::kSilence);
}

// FAULT-010: off the bus nothing can be heard, and that is not silence; the counter goes on meanwhile.
TEST(FaultJudge, BusOffIsNotSilence) {
  Bench bench;
  EXPECT_EQ(bench.ticks(20), Breach::kNone);
  for (int i = 0; i < 7; ++i) {
    bench.begin();
    (void)bench.frames();
    bench.judge.control_tick({}, true);
    bench.judge.end_tick();
  }
  EXPECT_EQ(bench.judge.verdict().outcome, Outcome::kCutOff);
  EXPECT_EQ(bench.ticks(20), Breach::kNone) << bench.judge.verdict().what;
}

// FAULT-011: each limit of the gate, overstepped by a little. At 20 m/s the lateral one is atan(6 x 2.9 /
// 400) = 0.0435 rad.
TEST(FaultJudge, FindsWhatIsOutsideTheLimits) {
  const auto expect = [](const char* limit, const auto& spoil, Bench bench = {}) {
    const Verdict verdict = spoiled(spoil, std::move(bench));
    EXPECT_EQ(verdict.breach, Breach::kLimits) << limit;
    EXPECT_EQ(verdict.what.substr(0, 8), limit) << verdict.what;
    EXPECT_EQ(verdict.tick, 21);
  };
  const auto with = [](const auto& change) {
    Bench bench;
    change(bench);
    return bench;
  };
  expect("GATE-001", [](Bench& b) { b.acceleration_mps2 = 3.51F; });
  expect("GATE-002", [](Bench& b) { b.acceleration_mps2 = -9.01F; });
  expect("GATE-003", [](Bench& b) { b.acceleration_mps2 = 0.215F; });
  expect(
      "GATE-004", [](Bench& b) { b.steering_rad = 0.551F; }, with([](Bench& b) {
        b.steering_rad = 0.549F;
        b.speed_mps = 2.0;
      }));
  expect("GATE-005", [](Bench& b) { b.steering_rad = 0.008F; });
  expect(
      "GATE-006", [](Bench& b) { b.steering_rad = 0.045F; }, with([](Bench& b) {
        b.speed_mps = 20.0;
        b.steering_rad = 0.043F;
      }));
  expect(
      "GATE-007", [](Bench& b) { b.acceleration_mps2 = 0.1F; }, with([](Bench& b) { b.speed_mps = 41.0; }));
  expect(
      "GATE-009", [](Bench& b) { b.acceleration_mps2 = -2.9F; }, with([](Bench& b) {
        b.mode = Mode::kStandby;
        b.acceleration_mps2 = -3.0F;
      }));
  expect(
      "a minimu", [](Bench& b) { b.acceleration_mps2 = 0.0F; }, with([](Bench& b) {
        b.mode = Mode::kMinimumRisk;
        b.faults = bit(FaultBit::kBusOff);
        b.acceleration_mps2 = -0.1F;
      }));
}

// FAULT-011: just inside is inside, and wheels above the lateral limit that turn back at full rate are too.
TEST(FaultJudge, AcceptsWhatIsJustInside) {
  const auto sound = [](const auto& change, Bench bench = {}) {
    EXPECT_EQ(spoiled(change, bench).breach, Breach::kNone) << spoiled(change, bench).what;
  };
  sound([](Bench& b) { b.acceleration_mps2 = 0.2F; });
  sound([](Bench& b) { b.acceleration_mps2 = -9.0F; });
  sound([](Bench& b) { b.steering_rad = 0.007F; });
  Bench turning;
  turning.speed_mps = 5.0;
  turning.steering_rad = 0.2F;
  sound(
      [](Bench& b) {
        b.speed_mps = 20.0;
        b.steering_rad = 0.193F;
      },
      turning);
}

// FAULT-010: a command that echoes a frame too many does not come from an ECU in step with its bus.
TEST(FaultJudge, CountsFrames) {
  const Verdict verdict = spoiled([](Bench& b) { b.judge.taken({0x7FF, 8, {}}); });
  EXPECT_EQ(verdict.breach, Breach::kSilence);
}

// FAULT-011: the speed is that of the newest intact motion frame; a damaged one, or one with a counter as
// before, does not count.
TEST(FaultJudge, KnowsWhatTheEcuKnows) {
  Bench bench;
  bench.speed_mps = 5.0;
  bench.steering_rad = 0.1F;
  EXPECT_EQ(bench.ticks(20), Breach::kNone);
  bench.motion = false;
  wire::Motion fast;
  fast.speed_mps = 30.0F;
  Frame frame;
  ASSERT_TRUE(wire::encode(fast, frame));
  bench.take(frame);                                                        // no CRC
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | 4U);  // twenty frames, counters 0 .. 14
  wire::e2e_seal(frame);
  bench.take(frame);
  EXPECT_EQ(bench.ticks(1), Breach::kNone) << bench.judge.verdict().what;
  frame.data[1] = static_cast<std::uint8_t>((frame.data[1] & 0xF0U) | 5U);
  wire::e2e_seal(frame);
  bench.take(frame);
  EXPECT_EQ(bench.ticks(1), Breach::kLimits);
}

// FAULT-011: ten ticks without a motion frame are allowed; after that only braking is.
TEST(FaultJudge, StaleMotionMustBrake) {
  Bench bench;
  EXPECT_EQ(bench.ticks(20), Breach::kNone);
  bench.motion = false;
  EXPECT_EQ(bench.ticks(10), Breach::kNone);
  EXPECT_EQ(bench.ticks(1), Breach::kLimits);
}

// FAULT-011: told 20 m/s, the gate may let the wheels be at atan(6 x 2.9 / 400) = 0.0435 rad, and they turn
// back from 0.2 rad by 0.007 rad a tick: 22 ticks, and a last one of 0.0025 rad. The motion has been stale
// for 12 of them by then, which is no reason to stop halfway; further in there is.
TEST(FaultJudge, StaleWheelsTurnBackToTheLateralLimit) {
  const auto verdict = [](float last_rad) {
    Bench bench;
    bench.speed_mps = 5.0;
    bench.steering_rad = 0.2F;
    EXPECT_EQ(bench.ticks(20), Breach::kNone);
    bench.speed_mps = 20.0;
    bench.acceleration_mps2 = -3.0F;
    for (int i = 1; i <= 22; ++i) {
      bench.steering_rad = 0.2F - 0.007F * static_cast<float>(i);
      EXPECT_EQ(bench.ticks(1), Breach::kNone) << bench.judge.verdict().what;
      bench.motion = false;
    }
    bench.steering_rad = last_rad;
    (void)bench.ticks(1);
    return bench.judge.verdict();
  };
  EXPECT_EQ(verdict(0.0434F).breach, Breach::kNone) << verdict(0.0434F).what;
  EXPECT_EQ(verdict(0.0415F).breach, Breach::kLimits);
}

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

// FAULT-014: an ECU that gives itself up is a failure.
TEST(FaultJudge, FaultModeIsAFailure) {
  const Verdict verdict = spoiled([](Bench& b) {
    b.mode = Mode::kFault;
    b.acceleration_mps2 = -3.0F;
  });
  EXPECT_EQ(verdict.breach, Breach::kFaultMode);
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
