// What the judge of fault scripts says of the frames an ECU sends.
#include "tests/support/judge_bench.hpp"

namespace s4tp::faults {
namespace {

using ecu::FaultBit;
using ecu::Mode;
using wire::Frame;

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

// FAULT-014: an ECU that gives itself up is a failure.
TEST(FaultJudge, FaultModeIsAFailure) {
  const Verdict verdict = spoiled([](Bench& b) {
    b.mode = Mode::kFault;
    b.acceleration_mps2 = -3.0F;
  });
  EXPECT_EQ(verdict.breach, Breach::kFaultMode);
}

}  // namespace
}  // namespace s4tp::faults
