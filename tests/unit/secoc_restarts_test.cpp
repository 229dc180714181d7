// Sessions of firmware/secoc over a bus: how they begin and end; restarts in any order, lost and replayed nonces.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "firmware/secoc/session.hpp"
#include "tests/support/secoc_rig.hpp"

namespace s4tp::secoc {
namespace {

// AUTH-012 From nothing, both ways work within a third of a second; with half of the nonces lost, within a
// second.
TEST(SecocSession, BeginsByItself) {
  SecocRig rig;
  const int ticks = rig.until_both_ways();
  EXPECT_GE(ticks, 0);
  EXPECT_LE(ticks, 20);

  std::mt19937 dice(1);
  for (int run = 0; run < 50; ++run) {
    SecocRig lossy;
    lossy.wire.lost = [&](const wire::Frame& frame) {
      return (frame.id == wire::kNonceEcuId || frame.id == wire::kNonceWorldId) && dice() % 2 == 0;
    };
    const int lossy_ticks = lossy.until_both_ways();
    EXPECT_GE(lossy_ticks, 0) << run;
    EXPECT_LE(lossy_ticks, 100) << run;
  }
}

// AUTH-011 Either end restarts, then the other, then both at once, in the middle of a session: both ways work
// again within 300 ms, each time under a new key.
TEST(SecocSession, EitherEndMayRestart) {
  SecocRig rig;
  ASSERT_GE(rig.until_both_ways(), 0);
  for (int i = 0; i < 20; ++i) {
    const int who = i % 3;
    for (int j = 0; j < 37 * i; ++j) (void)rig.tick();
    if (who != 1) rig.ecu.restart();
    if (who != 0) rig.world.restart();
    const int ticks = rig.until_both_ways();
    EXPECT_GE(ticks, 0) << i;
    EXPECT_LE(ticks, 30) << i;
  }
  // A frame more or less, and it goes on without a gap.
  for (int i = 0; i < 500; ++i) {
    const SecocRig::Arrived arrived = rig.tick();
    EXPECT_TRUE(arrived.motion && arrived.command) << i;
  }
}

// AUTH-011 The other end restarts while nonces of one side are lost for half a second: it takes that much
// longer and no more.
TEST(SecocSession, RestartWithLostNonces) {
  for (const std::uint32_t id : {wire::kNonceEcuId, wire::kNonceWorldId}) {
    SecocRig rig;
    ASSERT_GE(rig.until_both_ways(), 0);
    rig.ecu.restart();
    const int until = rig.number + 50;
    rig.wire.lost = [&](const wire::Frame& frame) { return frame.id == id && rig.number < until; };
    const int ticks = rig.until_both_ways();
    EXPECT_GE(ticks, 20) << id;
    EXPECT_LE(ticks, 90) << id;
  }
}

// AUTH-013 Nonces of an old session are said again in the middle of a live one, of either end, ten times a
// second: not one frame is lost by it, and no recorded companion of the old session verifies.
TEST(SecocSession, ReplayedNoncesTakeNothingAway) {
  SecocRig rig;
  ASSERT_GE(rig.until_both_ways(), 0);
  for (int i = 0; i < 50; ++i) (void)rig.tick();
  const std::vector<wire::Frame> recorded = rig.wire.seen;
  rig.world.restart();
  rig.ecu.restart();
  ASSERT_GE(rig.until_both_ways(), 0);
  const std::uint32_t verified = rig.ecu.can->tally().verified;
  const std::uint32_t nonces = static_cast<std::uint32_t>(rig.seen(wire::kNonceEcuId).size());
  int replayed = 0;
  for (int i = 0; i < 300; ++i) {
    for (const wire::Frame& frame : recorded) {
      const bool nonce = frame.id == wire::kNonceEcuId || frame.id == wire::kNonceWorldId;
      if (i % 10 == 0 && nonce) rig.inject(frame);
    }
    // A whole recorded motion group, before the genuine one.
    for (int k = 0; k < 8; ++k) rig.inject(recorded[static_cast<std::size_t>(replayed++) % recorded.size()]);
    const SecocRig::Arrived arrived = rig.tick();
    EXPECT_TRUE(arrived.motion && arrived.command) << i;
  }
  EXPECT_EQ(rig.ecu.can->tally().verified, verified + 300U);
  EXPECT_GT(rig.ecu.can->tally().refused, 0U);
  EXPECT_EQ(rig.ecu.can->session().sessions(), 1U);
  // It answers, but never more often than ten times a second.
  EXPECT_LE(rig.seen(wire::kNonceEcuId).size(), nonces + 31U);
}

// AUTH-013 An end restarts under a storm of replayed and invented nonces: there is no session while the storm
// lasts, or there is; once it is over both ways work again within two seconds.
TEST(SecocSession, ComesBackAfterAStorm) {
  SecocRig rig;
  ASSERT_GE(rig.until_both_ways(), 0);
  const std::vector<wire::Frame> recorded = rig.wire.seen;
  rig.world.restart();
  for (int i = 0; i < 400; ++i) {
    for (const wire::Frame& frame : recorded) {
      if (frame.id == wire::kNonceEcuId || frame.id == wire::kNonceWorldId) rig.inject(frame);
    }
    for (const std::uint32_t id : {wire::kNonceEcuId, wire::kNonceWorldId}) {
      wire::Frame forged{
          id, 8, {0, static_cast<std::uint8_t>(i % 2), static_cast<std::uint8_t>(16 * i), 1, 2}};
      wire::e2e_seal(forged);
      rig.inject(forged);
    }
    (void)rig.tick();
  }
  const int ticks = rig.until_both_ways();
  EXPECT_GE(ticks, 0);
  EXPECT_LE(ticks, 200);
}

// AUTH-013 Traffic of an old session of the ECU's present start, replayed after the world has restarted, does
// not bring that session back: the ECU, too, has a new nonce.
TEST(SecocSession, AnOldSessionDoesNotComeBack) {
  SecocRig rig;
  ASSERT_GE(rig.until_both_ways(), 0);
  for (int i = 0; i < 20; ++i) (void)rig.tick();
  const std::vector<wire::Frame> recorded = rig.wire.seen;
  rig.world.restart();
  ASSERT_GE(rig.until_both_ways(), 0);
  rig.to_ecu.clear();
  for (const wire::Frame& frame : recorded) {
    rig.inject(frame);
    for (const wire::Frame& taken : rig.ecu.take()) rig.to_ecu.push_back(taken);
  }
  EXPECT_EQ(count(rig.to_ecu, wire::kMotionId), 0);
  EXPECT_EQ(count(rig.to_ecu, wire::kSteeringId), 0);
  EXPECT_GT(count(recorded, wire::kMotionId), 20);
}

// AUTH-014 A bus that is cut for two seconds: the session is over after one, and another is there within
// 300 ms of the bus coming back.
TEST(SecocSession, EndsInSilence) {
  SecocRig rig;
  ASSERT_GE(rig.until_both_ways(), 0);
  rig.wire.lost = [](const wire::Frame&) { return true; };
  for (int i = 0; i < 95; ++i) (void)rig.tick();
  EXPECT_TRUE(rig.ecu.can->session().live());
  for (int i = 0; i < 105; ++i) (void)rig.tick();
  EXPECT_FALSE(rig.ecu.can->session().live());
  EXPECT_FALSE(rig.world.can->session().live());
  rig.wire.lost = nullptr;
  const int ticks = rig.until_both_ways();
  EXPECT_GE(ticks, 0);
  EXPECT_LE(ticks, 30);
}

}  // namespace
}  // namespace s4tp::secoc
