// Maps that contradict themselves are refused.

#include <gtest/gtest.h>

#include <vector>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/lane_map.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/support/map_link.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {
namespace {

constexpr std::uint8_t kRevision = 1;  // of all records

/// Frames of a map as an inconsistent sender might send it, header and all.
class InconsistentMap : public LaneMapTest {
 protected:
  void send(const Map& map, int lane_count) {
    MapHeader header;
    header.generation = 9;
    header.lane_count = static_cast<std::uint8_t>(lane_count);
    header.conflict_count = 1;
    MapSlots slots[2];
    slots[0].in_use = (1U << lane_count) - 1U;
    slots[1].half = 1;
    RevisionDigest revisions[2];
    std::vector<Frame> frames;
    std::uint16_t digest = 0;
    const auto add_record = [&](const auto& record, int slot) {
      for (int part = 0; part < part_count(record); ++part) {
        Frame frame;
        ASSERT_TRUE(encode_part(record, slot, kRevision, part, frame));
        frames.push_back(frame);
        digest = static_cast<std::uint16_t>(digest + frame_check(frame));
      }
    };
    for (int slot = 0; slot < lane_count; ++slot) add_record(map.lanes[slot], slot);
    add_record(map.conflicts[0], 0);
    header.digest = digest;
    for (int record = 0; record < lane_count + header.conflict_count; ++record) revisions[0].add(kRevision);
    for (MapSlots& half : slots) half.revisions = revisions[half.half].value();
    for (int round = 0; round < 2; ++round) {  // the first header is not trusted yet
      Frame frame;
      ASSERT_TRUE(encode(header, frame));
      protection_.protect(frame);
      maps_ += receiver_.accept(frame) ? 1 : 0;
      for (MapSlots& half : slots) {
        half.generation = 9;
        ASSERT_TRUE(encode(half, frame));
        e2e_seal(frame);
        maps_ += receiver_.accept(frame) ? 1 : 0;
      }
      for (const Frame& record : frames) maps_ += receiver_.accept(record) ? 1 : 0;
    }
  }

  E2eSender protection_;
  int maps_ = 0;
};

TEST_F(InconsistentMap, TheTestsOwnSenderIsUnderstood) {
  send(sample_map(3, 3, 1), 3);
  EXPECT_EQ(maps_, 1);
}

// Whole and with the right digest, but a successor that does not exist.
TEST_F(InconsistentMap, LinksToAbsentLanesAreRefused) {
  Map map = sample_map(3, 3, 1);
  map.lanes[1].successors[1] = 60;
  send(map, 3);
  EXPECT_EQ(maps_, 0);
  EXPECT_GT(receiver_.rejected_frames(), 0);
}

TEST_F(InconsistentMap, ConflictsOfAbsentLanesAreRefused) {
  Map map = sample_map(3, 3, 1);
  map.conflicts[0].second = 5;
  send(map, 3);
  EXPECT_EQ(maps_, 0);
}

TEST_F(InconsistentMap, ConflictsLeftBeforeTheyAreEnteredAreRefused) {
  Map map = sample_map(3, 3, 1);
  map.conflicts[0].second_exit_m = map.conflicts[0].second_entry_m - 0.5F;
  map.conflicts[0].second_entry_m += 1.0F;
  map.conflicts[0].second_exit_m += 1.0F;
  send(map, 3);
  EXPECT_EQ(maps_, 0);
}

TEST_F(InconsistentMap, ALaneOfOnePointIsRefused) {
  Map map = sample_map(3, 3, 1);
  map.lanes[2].point_count = 1;
  send(map, 3);
  EXPECT_EQ(maps_, 0);
}

}  // namespace
}  // namespace s4tp::wire
