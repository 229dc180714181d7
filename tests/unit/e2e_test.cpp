#include "firmware/wire/e2e.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "firmware/wire/crc16.hpp"

namespace s4tp::wire {
namespace {

Frame with_counter(int counter) {
  Frame frame{0x010, 8, {0, static_cast<std::uint8_t>(0xA0 | counter), 2, 3, 4, 5, 6, 7}};
  e2e_seal(frame);
  return frame;
}

/// The states a receiver goes through for frames with these counters; -1: a period without a frame.
std::vector<E2eState> states(E2eReceiver& receiver, const std::vector<int>& counters) {
  std::vector<E2eState> result;
  for (const int counter : counters) {
    result.push_back(counter < 0 ? receiver.nothing_arrived() : receiver.check(with_counter(counter)));
    EXPECT_EQ(receiver.state(), result.back());
  }
  return result;
}

std::vector<E2eState> states(const std::vector<int>& counters) {
  E2eReceiver receiver;
  return states(receiver, counters);
}

std::vector<int> silence(int periods) {
  return std::vector<int>(static_cast<std::size_t>(periods), -1);
}

using enum E2eState;
using States = std::vector<E2eState>;

// CRC-8 of "123456789" with polynomial 0x1D, initial and final 0xFF is published as 0x4B; '1' and '2' are the
// data id here, '3' to '9' the payload.
TEST(E2e, CrcHasThePublishedCheckValue) {
  const Frame frame{0x3231, 8, {0, '3', '4', '5', '6', '7', '8', '9'}};
  EXPECT_EQ(e2e_crc(frame), 0x4B);
}

// WIRE-001: the CRC covers id and payload; the counter may be anything.
TEST(E2e, CrcFitsOnlyTheFrameItWasMadeFor) {
  for (int counter = 0; counter < 16; ++counter) EXPECT_TRUE(e2e_crc_fits(with_counter(counter)));
  const Frame good = with_counter(3);
  for (int bit = 0; bit < 64; ++bit) {
    Frame bad = good;
    bad.data[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_FALSE(e2e_crc_fits(bad)) << bit;
  }
  Frame renamed = good;
  renamed.id = 0x011;
  EXPECT_FALSE(e2e_crc_fits(renamed));
}

// WIRE-001: too short to carry CRC and counter, or longer than a classic frame.
TEST(E2e, ImpossibleLengthsDoNotFit) {
  for (const int length : {0, 1, 9, 255}) {
    Frame frame = with_counter(1);
    frame.length = static_cast<std::uint8_t>(length);
    e2e_seal(frame);
    EXPECT_FALSE(e2e_crc_fits(frame)) << length;
  }
}

// Counters run 0 to 14 and start again; the high nibble of byte 1 belongs to the message.
TEST(E2e, SenderCountsToFourteen) {
  E2eSender sender;
  for (int i = 0; i < 31; ++i) {
    Frame frame{0x010, 8, {0, 0xA0}};
    sender.protect(frame);
    EXPECT_EQ(frame.data[1], 0xA0 | (i % 15));
    EXPECT_TRUE(e2e_crc_fits(frame));
  }
}

// WIRE-014, WIRE-010: the first frame only starts the counting; also across the wrap from 14 to 0.
TEST(E2e, IsOkFromTheSecondFrameOn) {
  EXPECT_EQ(states({12, 13, 14, 0, 1}), (States{kInitial, kOk, kOk, kOk, kOk}));
}

// WIRE-011
TEST(E2e, NothingArrivedIsNoNewData) {
  EXPECT_EQ(E2eReceiver{}.state(), kNoNewData);
  EXPECT_EQ(states({0, 1, -1}), (States{kInitial, kOk, kNoNewData}));
}

// WIRE-012: also for counter 15, which no sender uses.
TEST(E2e, DamageIsWrongCrc) {
  E2eReceiver receiver;
  EXPECT_EQ(states(receiver, {0, 1}), (States{kInitial, kOk}));
  Frame bad = with_counter(2);
  bad.data[5] ^= 0x10;
  EXPECT_EQ(receiver.check(bad), kWrongCrc);
  EXPECT_EQ(states(receiver, {15}), (States{kWrongCrc}));
  EXPECT_EQ(states(receiver, {2}), (States{kOk}));
}

// WIRE-015
TEST(E2e, TheSameCounterAgainIsRepeated) {
  EXPECT_EQ(states({0, 1, 1, 1, 2}), (States{kInitial, kOk, kRepeated, kRepeated, kOk}));
}

// WIRE-016: steps of 2 and 3 are trusted; so is 4 after one period without a frame, which widens the step
// by 1.
TEST(E2e, SmallStepsAreOkSomeLost) {
  EXPECT_EQ(states({0, 2, 5}), (States{kInitial, kOkSomeLost, kOkSomeLost}));
  EXPECT_EQ(states({0, 1, -1, 5}), (States{kInitial, kOk, kNoNewData, kOkSomeLost}));
  EXPECT_EQ(states({0, 1, -1, 6}), (States{kInitial, kOk, kNoNewData, kWrongSequence}));
}

// WIRE-017, WIRE-013: a step of 4 is too much; two plausible frames follow before the third is trusted.
TEST(E2e, AJumpHasToBeResynchronised) {
  EXPECT_EQ(states({0, 4, 5, 6, 7}), (States{kInitial, kWrongSequence, kSync, kSync, kOk}));
  EXPECT_EQ(states({0, 4, 9, 10, 11, 12}),
            (States{kInitial, kWrongSequence, kWrongSequence, kSync, kSync, kOk}));
}

// WIRE-013: 10 periods without a frame are bridged; after 11 trust has to be earned again.
TEST(E2e, LongSilenceCostsTheTrust) {
  E2eReceiver bridged;
  static_cast<void>(states(bridged, {0, 1}));
  static_cast<void>(states(bridged, silence(10)));
  EXPECT_EQ(states(bridged, {12, 13}), (States{kOkSomeLost, kOk}));
  E2eReceiver lost;
  static_cast<void>(states(lost, {0, 1}));
  static_cast<void>(states(lost, silence(11)));
  EXPECT_EQ(states(lost, {13, 14, 0}), (States{kSync, kSync, kOk}));
}

// WIRE-013: however long the silence: 256 periods are not none.
TEST(E2e, VeryLongSilenceCostsTheTrustToo) {
  E2eReceiver receiver;
  static_cast<void>(states(receiver, {0, 1}));
  static_cast<void>(states(receiver, silence(256)));
  EXPECT_EQ(states(receiver, {2, 3, 4}), (States{kSync, kSync, kOk}));
}

// WIRE-013: a sender that hangs on one counter is as silent as one that sends nothing.
TEST(E2e, RepetitionForLongCostsTheTrust) {
  E2eReceiver receiver;
  static_cast<void>(states(receiver, std::vector<int>(12, 5)));
  EXPECT_EQ(states(receiver, {6, 7, 8}), (States{kSync, kSync, kOk}));
}

TEST(E2e, OnlyOkAndOkSomeLostAreTrusted) {
  for (const E2eState state : {kNoNewData, kWrongCrc, kSync, kInitial, kRepeated, kWrongSequence}) {
    EXPECT_FALSE(E2eReceiver::trusted(state));
  }
  EXPECT_TRUE(E2eReceiver::trusted(kOk));
  EXPECT_TRUE(E2eReceiver::trusted(kOkSomeLost));
}

// WIRE-004: the check value of CRC-16/CCITT-FALSE, "123456789", is 0x29B1. Of a frame the id counts too.
TEST(Crc16, IsTheOneEverybodyKnows) {
  std::uint16_t crc = kCrc16Start;
  for (const char digit : {'1', '2', '3', '4', '5', '6', '7', '8', '9'}) {
    crc = crc16_add(crc, static_cast<std::uint8_t>(digit));
  }
  EXPECT_EQ(crc, 0x29B1);
  const Frame frame{'1', 8, {'2', '3', '4', '5', '6', '7', '8', '9'}};
  EXPECT_EQ(frame_check(frame), 0x29B1);
}

}  // namespace
}  // namespace s4tp::wire
