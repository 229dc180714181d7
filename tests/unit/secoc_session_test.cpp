// A session of firmware/secoc: what its key and its freshness values let pass.
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

}  // namespace
}  // namespace s4tp::secoc
