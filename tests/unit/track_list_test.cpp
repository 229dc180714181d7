#include "firmware/wire/track_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "firmware/wire/codec.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {
namespace {

/// A sender and a receiver between which one list has already passed, so that headers are trusted.
class TrackListTest : public ::testing::Test {
 protected:
  TrackListTest() {
    deliver(frames_of(sender_, sample_tracks(1, 1)));
    deliver(frames_of(sender_, sample_tracks(1, 2)));
  }

  /// How many lists became whole.
  int deliver(const std::vector<Frame>& frames) {
    int lists = 0;
    for (const Frame& frame : frames) lists += receiver_.accept(frame) ? 1 : 0;
    return lists;
  }

  TrackListSender sender_;
  TrackListReceiver receiver_;
};

// WIRE-020: the first header of all is not trusted yet (E2E INITIAL), the second is.
TEST(TrackList, CountsFromTheSecondHeaderOn) {
  TrackListSender sender;
  TrackListReceiver receiver;
  int lists = 0;
  for (const Frame& frame : frames_of(sender, sample_tracks(3, 1))) lists += receiver.accept(frame) ? 1 : 0;
  EXPECT_EQ(lists, 0);
  for (const Frame& frame : frames_of(sender, sample_tracks(3, 2))) lists += receiver.accept(frame) ? 1 : 0;
  EXPECT_EQ(lists, 1);
  EXPECT_EQ(receiver.rejected_frames(), 0);
  EXPECT_EQ(receiver.broken_lists(), 0);
}

// 1 header and 2 members a track; whole with the last of them.
TEST_F(TrackListTest, ArrivesAsItWasSent) {
  for (int count = 0; count <= kMaxTracks; ++count) {
    const Tracks sent = sample_tracks(count, 50 + count);
    std::vector<Frame> frames = frames_of(sender_, sent);
    ASSERT_EQ(frames.size(), 1U + 2U * static_cast<unsigned>(count));
    const Frame last = frames.back();
    frames.pop_back();
    EXPECT_EQ(deliver(frames), 0) << count;
    EXPECT_TRUE(receiver_.accept(last)) << count;
    EXPECT_TRUE(receiver_.tracks() == sent) << count;
  }
}

// WIRE-020: whichever of its 9 frames is missing, the list before it stands.
TEST_F(TrackListTest, WithoutOneFrameThereIsNoList) {
  const Tracks before = receiver_.tracks();
  for (int missing = 0; missing < 9; ++missing) {
    TrackListSender sender = sender_;
    TrackListReceiver receiver = receiver_;
    std::vector<Frame> frames = frames_of(sender, sample_tracks(4, 9));
    ASSERT_EQ(frames.size(), 9U);
    frames.erase(frames.begin() + missing);
    for (const Frame& frame : frames) EXPECT_FALSE(receiver.accept(frame)) << missing;
    EXPECT_TRUE(receiver.tracks() == before) << missing;
  }
}

// WIRE-020: a list half delivered is over with the next header; it is counted, and the next one arrives.
TEST_F(TrackListTest, AHalfDeliveredListIsCounted) {
  std::vector<Frame> half = frames_of(sender_, sample_tracks(4, 3));
  half.resize(5);
  EXPECT_EQ(deliver(half), 0);
  const Tracks next = sample_tracks(2, 4);
  EXPECT_EQ(deliver(frames_of(sender_, next)), 1);
  EXPECT_TRUE(receiver_.tracks() == next);
  EXPECT_EQ(receiver_.broken_lists(), 1);
}

// WIRE-020: the last member of a list is missing, and the same one of the next list arrives whose header was
// lost: it does not complete the list, but ends it, so that the missing one comes too late.
TEST_F(TrackListTest, GenerationsAreNotMixed) {
  const std::vector<Frame> first = frames_of(sender_, sample_tracks(2, 3));
  const std::vector<Frame> second = frames_of(sender_, sample_tracks(2, 4));
  EXPECT_EQ(deliver({first[0], first[1], first[2], first[3]}), 0);
  EXPECT_EQ(deliver({second[4]}), 0);
  EXPECT_EQ(receiver_.broken_lists(), 1);
  EXPECT_EQ(deliver({first[4], second[1], second[2], second[3], second[4]}), 0);
}

// WIRE-020: a member of the list before, late, neither completes nor ends this one.
TEST_F(TrackListTest, LateMembersChangeNothing) {
  const Tracks sent = sample_tracks(2, 4);
  const std::vector<Frame> first = frames_of(sender_, sample_tracks(2, 3));
  const std::vector<Frame> second = frames_of(sender_, sent);
  EXPECT_EQ(deliver({second[0], second[1], second[2], second[3], first[4]}), 0);
  EXPECT_EQ(deliver({second[4]}), 1);
  EXPECT_TRUE(receiver_.tracks() == sent);
}

/// The member says something else in `bit`, under a CRC that fits.
Frame forged(Frame member, unsigned bit) {
  member.data[bit / 8U] = static_cast<std::uint8_t>(member.data[bit / 8U] ^ (1U << (bit % 8U)));
  e2e_seal(member);
  return member;
}

// WIRE-023: any bit of any member that says something else, or the same bit of two, sealed: the list is void,
// counted and rejected, and the one before stands. The next one counts.
TEST_F(TrackListTest, ADigestThatDoesNotFitVoidsTheList) {
  constexpr unsigned kFirstBit = 16;  // behind generation and index
  const Tracks before = receiver_.tracks();
  int voided = 0;
  int tried = 0;
  for (unsigned bit = kFirstBit; bit < 63; ++bit) {
    for (std::size_t member = 1; member < 9; ++member) {
      TrackListSender sender = sender_;
      TrackListReceiver receiver = receiver_;
      std::vector<Frame> frames = frames_of(sender, sample_tracks(4, 9));
      frames[member] = forged(frames[member], bit);
      if (member > 2) frames[member - 2] = forged(frames[member - 2], bit);
      int lists = 0;
      for (const Frame& frame : frames) lists += receiver.accept(frame) ? 1 : 0;
      ASSERT_EQ(lists, 0) << bit << " of member " << member;
      ASSERT_TRUE(receiver.tracks() == before);
      ++tried;
      // A value the wire does not know is rejected at once; then the list never becomes whole.
      voided += receiver.voided_lists();
      EXPECT_GE(receiver.rejected_frames(), 1);
      for (const Frame& frame : frames_of(sender, before)) lists += receiver.accept(frame) ? 1 : 0;
      ASSERT_EQ(lists, 1);
    }
  }
  EXPECT_GT(voided, tried / 2);
}

// WIRE-024: the true member first or the forged one first: once two differ there is no list.
TEST_F(TrackListTest, AContradictionVoidsTheList) {
  for (const bool forged_first : {true, false}) {
    for (const std::size_t member : {3U, 4U}) {
      std::vector<Frame> frames = frames_of(sender_, sample_tracks(4, 9));
      const Frame other = forged(frames[member], 20);
      const int voided = receiver_.voided_lists();
      const int rejected = receiver_.rejected_frames();
      frames.insert(frames.begin() + static_cast<int>(member) + (forged_first ? 0 : 1), other);
      EXPECT_EQ(deliver(frames), 0);
      EXPECT_EQ(receiver_.voided_lists(), voided + 1);
      EXPECT_EQ(receiver_.rejected_frames(), rejected + 1);
    }
  }
  EXPECT_EQ(deliver(frames_of(sender_, sample_tracks(2, 4))), 1);
}

// WIRE-024: a frame that came twice bit for bit.
TEST_F(TrackListTest, RepeatedFramesChangeNothing) {
  const Tracks sent = sample_tracks(3, 5);
  int lists = 0;
  for (const Frame& frame : frames_of(sender_, sent)) lists += deliver({frame, frame, frame});
  EXPECT_EQ(lists, 1);
  EXPECT_TRUE(receiver_.tracks() == sent);
}

TEST_F(TrackListTest, MembersMayComeInAnyOrder) {
  const Tracks sent = sample_tracks(5, 6);
  std::vector<Frame> frames = frames_of(sender_, sent);
  std::reverse(frames.begin() + 1, frames.end());
  EXPECT_EQ(deliver(frames), 1);
  EXPECT_TRUE(receiver_.tracks() == sent);
}

// A damaged member is dropped and counted; sent again whole, it completes the list.
TEST_F(TrackListTest, DamagedFramesAreRejected) {
  const Tracks sent = sample_tracks(1, 7);
  std::vector<Frame> frames = frames_of(sender_, sent);
  Frame damaged = frames[2];
  damaged.data[4] ^= 0x40;
  EXPECT_EQ(deliver({frames[0], frames[1], damaged}), 0);
  EXPECT_EQ(receiver_.rejected_frames(), 1);
  EXPECT_EQ(deliver({frames[2]}), 1);
  EXPECT_TRUE(receiver_.tracks() == sent);
}

// A member of the right generation, but beyond the count of its header.
TEST_F(TrackListTest, AMemberBeyondTheCountIsRejected) {
  std::vector<Frame> frames = frames_of(sender_, sample_tracks(2, 7));
  TrackPose pose;
  ASSERT_TRUE(decode(frames[1], pose));
  pose.index = 2;
  Frame beyond;
  ASSERT_TRUE(encode(pose, beyond));
  e2e_seal(beyond);
  EXPECT_EQ(deliver({frames[0], beyond}), 0);
  EXPECT_EQ(receiver_.rejected_frames(), 1);
}

TEST_F(TrackListTest, OtherMessagesAreNotItsBusiness) {
  EXPECT_FALSE(receiver_.accept(Frame{kMotionId, 8, {}}));
  EXPECT_EQ(receiver_.rejected_frames(), 0);
}

// WIRE-021: 1311 m is beyond 18 bits of 0.01 m, and a width of 3.2 m beyond 5 bits of 0.1 m; NaN is nowhere.
TEST_F(TrackListTest, TracksThatDoNotFitAreLeftOut) {
  Tracks tracks = sample_tracks(5, 3);
  tracks.left_out = 2;
  tracks.items[0].x_m = 1311.0F;
  tracks.items[2].width_m = 3.2F;
  tracks.items[3].heading_rad = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(deliver(frames_of(sender_, tracks)), 1);
  EXPECT_EQ(receiver_.tracks().count, 2);
  EXPECT_EQ(receiver_.tracks().left_out, 5);
  EXPECT_TRUE(receiver_.tracks().items[0] == tracks.items[1]);
  EXPECT_TRUE(receiver_.tracks().items[1] == tracks.items[4]);
}

// WIRE-022: generation 4 bit: 16 lists later it is the same again. If the bus falls silent for exactly that
// long and the header is lost too, only the silence tells the lists apart.
TEST_F(TrackListTest, SilenceEndsTheListBegun) {
  const std::vector<Frame> old = frames_of(sender_, sample_tracks(2, 3));
  EXPECT_EQ(deliver({old[0], old[1], old[2], old[3]}), 0);
  for (int i = 0; i < 15; ++i) static_cast<void>(frames_of(sender_, sample_tracks(2, 4)));
  const std::vector<Frame> same_generation = frames_of(sender_, sample_tracks(2, 5));
  receiver_.nothing_arrived();
  EXPECT_FALSE(receiver_.accept(same_generation[4]));
  EXPECT_EQ(receiver_.broken_lists(), 1);
}

}  // namespace
}  // namespace s4tp::wire
