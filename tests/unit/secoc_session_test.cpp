// Sessions of firmware/secoc: nonces, keys, freshness; restarts in any order, lost and replayed nonces.
#include <gtest/gtest.h>

#include <vector>

#include "firmware/secoc/session.hpp"
#include "tests/support/secoc_rig.hpp"

namespace s4tp::secoc {
namespace {

Message text(std::uint8_t mark, Group group = Group::kCommand) {
  Message message(group);
  message.add_byte(mark);
  return message;
}

/// Two sessions that have met.
struct Pair {
  Pair() {
    Nonce nonce;
    EXPECT_TRUE(ecu.ask(nonce));
    world.hear(nonce);
    EXPECT_TRUE(world.ask(nonce));
    ecu.hear(nonce);
    EXPECT_TRUE(passes(ecu, world, 1));
    EXPECT_TRUE(passes(world, ecu, 1, Group::kMotion));
  }
  static bool passes(Session& from, Session& to, std::uint8_t mark, Group group = Group::kCommand) {
    Message sent = text(mark, group);
    Message received = text(mark, group);
    Companion companion;
    return from.seal(sent, companion) && to.verify(received, companion);
  }
  hal::linux_host::AuthenticationKey key = new_key();
  TestKeys ecu_keys{key};
  TestKeys world_keys{key};
  Session ecu{ecu_keys, End::kEcu};
  Session world{world_keys, End::kWorld};
};

// AUTH-010 Both ends are in a session once a companion has verified each way; an end with another long-term
// key never is.
TEST(SecocSession, NeedsTheSameKey) {
  Pair pair;
  EXPECT_TRUE(pair.ecu.live());
  EXPECT_TRUE(pair.world.live());
  TestKeys other(new_key());
  Session stranger(other, End::kEcu);
  Session world(pair.world_keys, End::kWorld);
  Nonce nonce;
  ASSERT_TRUE(stranger.ask(nonce));
  world.hear(nonce);
  ASSERT_TRUE(world.ask(nonce));
  stranger.hear(nonce);
  EXPECT_FALSE(Pair::passes(stranger, world, 1));
  EXPECT_FALSE(world.live());
}

// AUTH-001, AUTH-003 Any one bit changed, of the message, its group, the MAC or the freshness value: refused.
// 48 bits of MAC are compared, so of 48 single-bit forgeries none passes.
TEST(SecocSession, RefusesEveryChangedBit) {
  Pair pair;
  Message sent = text(0x5A);
  Companion good;
  ASSERT_TRUE(pair.ecu.seal(sent, good));
  for (unsigned bit = 0; bit < 48; ++bit) {
    Companion forged = good;
    forged.mac ^= std::uint64_t{1} << bit;
    Message message = text(0x5A);
    EXPECT_FALSE(pair.world.verify(message, forged)) << bit;
  }
  for (unsigned bit = 0; bit < 16; ++bit) {
    Companion forged = good;
    forged.freshness = static_cast<std::uint16_t>(forged.freshness ^ 1U << bit);
    Message message = text(0x5A);
    EXPECT_FALSE(pair.world.verify(message, forged)) << bit;
  }
  for (unsigned bit = 0; bit < 8; ++bit) {
    Message message = text(static_cast<std::uint8_t>(0x5AU ^ 1U << bit));
    EXPECT_FALSE(pair.world.verify(message, good)) << bit;
  }
  Message of_another_group = text(0x5A, Group::kMotion);
  EXPECT_FALSE(pair.world.verify(of_another_group, good));
  Message message = text(0x5A);
  EXPECT_TRUE(pair.world.verify(message, good));
}

// AUTH-004 What has verified never does again; neither does what was sent before it.
TEST(SecocSession, RefusesReplayedAndReordered) {
  Pair pair;
  Companion companions[3];
  for (Companion& companion : companions) {
    Message sent = text(7);
    ASSERT_TRUE(pair.ecu.seal(sent, companion));
  }
  Message message = text(7);
  EXPECT_TRUE(pair.world.verify(message, companions[1]));
  EXPECT_FALSE(pair.world.verify(message, companions[1]));
  EXPECT_FALSE(pair.world.verify(message, companions[0]));
  EXPECT_TRUE(pair.world.verify(message, companions[2]));
}

// AUTH-002, AUTH-004 The 16 bits that travel come round: across three wraps every companion verifies, with
// gaps of up to 65,535, and one from 65,536 ago, whose 16 bits fit, does not.
TEST(SecocSession, FreshnessWraps) {
  Pair pair;
  Companion old;
  Message sent = text(9);
  ASSERT_TRUE(pair.ecu.seal(sent, old));
  Message received = text(9);
  ASSERT_TRUE(pair.world.verify(received, old));
  int verified = 0;
  Companion companion;
  for (int i = 0; i < 65'535; ++i) ASSERT_TRUE(pair.ecu.seal(sent, companion));
  EXPECT_FALSE(pair.world.verify(received, old)) << "at its turn again";
  ASSERT_TRUE(pair.world.verify(received, companion)) << "65,535 further";
  for (int i = 0; i < 140'000; ++i) {
    ASSERT_TRUE(pair.ecu.seal(sent, companion));
    if (i % 7 != 0) continue;
    ASSERT_TRUE(pair.world.verify(received, companion)) << i;
    ++verified;
  }
  EXPECT_EQ(verified, 20'000);
  EXPECT_FALSE(pair.world.verify(received, old));
}

// AUTH-002 A fresh end whose counterpart changes its nonce does not begin to count anew: the freshness values
// under one own nonce are all different.
TEST(SecocSession, CountsOnWithItsNonce) {
  const hal::linux_host::AuthenticationKey key = new_key();
  TestKeys keys(key);
  Session end(keys, End::kEcu);
  std::vector<std::uint16_t> values;
  for (const std::uint64_t peer : {1U, 2U, 1U}) {
    end.hear({peer, true});
    for (int i = 0; i < 5; ++i) {
      Message message = text(1);
      Companion companion;
      ASSERT_TRUE(end.seal(message, companion));
      values.push_back(companion.freshness);
    }
  }
  for (std::size_t i = 1; i < values.size(); ++i) EXPECT_EQ(values[i], values[i - 1] + 1);
  EXPECT_EQ(keys.nonces, 1);
}

// AUTH-010 A keeper that fails (no random numbers, no CMAC) leaves the end without a key: nothing is sealed,
// nothing verifies, nothing is said.
TEST(SecocSession, FailsClosed) {
  Pair pair;
  Companion companion;
  Message message = text(3);
  ASSERT_TRUE(pair.ecu.seal(message, companion));
  pair.world_keys.works = false;
  Message received = text(3);
  EXPECT_FALSE(pair.world.verify(received, companion));
  TestKeys broken(pair.key);
  broken.works = false;
  Session end(broken, End::kEcu);
  Nonce nonce;
  EXPECT_FALSE(end.ask(nonce));
  end.hear({5, true});
  EXPECT_FALSE(end.has_key());
  EXPECT_FALSE(end.seal(message, companion));
}

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
