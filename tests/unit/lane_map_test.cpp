#include "firmware/wire/lane_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/crc16.hpp"
#include "firmware/wire/map_record.hpp"
#include "tests/support/map_link.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::wire {
namespace {

TEST_F(LaneMapTest, NothingIsSentBeforeThereIsAMap) {
  Frame frame;
  EXPECT_FALSE(sender_.next(0, frame));
}

// WIRE-030
TEST_F(LaneMapTest, ArrivesAsItWasSent) {
  const Map sent = sample_map(7, 5, 6);
  sender_.update(sent);
  EXPECT_EQ(run(300), 1);
  EXPECT_TRUE(receiver_.map() == sent);
  EXPECT_TRUE(receiver_.confirmed());
  EXPECT_EQ(receiver_.rejected_frames(), 0);
}

// WIRE-031: 64 x (3 + 12) + 128 x 2 = 1216 frames at 1000 a second, 30 of which are headers: 1.26 s; and
// 64 x (3 + 6) + 256 = 832 at 800 a second: 1.08 s.
TEST_F(LaneMapTest, TheLargestMapIsWholeWithinOneAndAHalfSeconds) {
  for (const auto& [points, pace] : {std::pair{12, 10}, std::pair{6, 8}}) {
    sender_ = MapSender{};
    receiver_ = MapReceiver{};
    const Map sent = sample_map(kMaxLanes, points, kMaxConflicts);
    sender_.update(sent);
    const std::uint32_t start_ms = now_ms_;
    EXPECT_EQ(run(1500, pace), 1);
    EXPECT_TRUE(receiver_.map() == sent);
    RecordProperty("whole_after_ms_" + std::to_string(points), static_cast<int>(whole_ms_ - start_ms));
  }
}

// WIRE-032: the longest time between two headers of the same lane, while two other lanes change all the time.
TEST_F(LaneMapTest, EveryRecordComesAgainWithinFiveSeconds) {
  Map map = sample_map(kMaxLanes, 6, kMaxConflicts);
  sender_.update(map);
  static_cast<void>(run(1500));
  std::map<int, std::uint32_t> last_ms;
  std::uint32_t longest_ms = 0;
  for (int round = 0; round < 150; ++round) {
    map.lanes[3].goal_distance_m = static_cast<float>(round);
    map.lanes[40].goal_distance_m = static_cast<float>(round);
    sender_.update(map);
    static_cast<void>(run(100, 10, [&](const Frame& frame) {
      LaneHeader lane;
      ConflictSecond conflict;
      int record = -1;
      if (decode(frame, lane)) record = lane.lane;
      if (decode(frame, conflict)) record = kMaxLanes + conflict.conflict;
      if (record < 0) return true;
      if (last_ms.contains(record)) longest_ms = std::max(longest_ms, now_ms_ - last_ms.at(record));
      last_ms[record] = now_ms_;
      return true;
    }));
  }
  EXPECT_EQ(last_ms.size(), static_cast<std::size_t>(kMaxLanes + kMaxConflicts));
  EXPECT_LE(longest_ms, 5000U);
  EXPECT_TRUE(receiver_.map() == map);
}

// WIRE-032: a map of one lane repeats it every 4.8 s; when it grows to 20 lanes right after that, they come
// every 0.24 s from then on, without waiting for the 4.8 s to end.
TEST_F(LaneMapTest, RepetitionFollowsTheSizeOfTheMap) {
  sender_.update(sample_map(1, 2, 0));
  static_cast<void>(run(10000));
  const Map grown = sample_map(20, 2, 0);
  sender_.update(grown);
  static_cast<void>(run(300, 10, [](const Frame& frame) { return frame.id != kLaneRouteId; }));
  EXPECT_EQ(run(5000), 1);
  EXPECT_TRUE(receiver_.map() == grown);
}

// WIRE-032: no bursts: 192 records in 4.8 s are one every 25 ms, so a tick starts one at most. It is a lane
// (3 + 6 frames) or a conflict (2); with the header's 3 frames 12 at most.
TEST_F(LaneMapTest, RepetitionIsSpreadEvenly) {
  sender_.update(sample_map(kMaxLanes, 6, kMaxConflicts));
  static_cast<void>(run(7000));
  int most = 0;
  for (int tick = 0; tick < 500; ++tick, now_ms_ += kTick_ms) {
    most = std::max(most, static_cast<int>(frames_of(sender_, now_ms_, 1000).size()));
  }
  EXPECT_LE(most, 3 + 9);
}

// Header and slots ten times a second: 3 frames each in 5 s.
TEST_F(LaneMapTest, HeaderGoesOutTenTimesASecond) {
  sender_.update(sample_map(3, 2, 1));
  std::map<std::uint32_t, int> frames;
  static_cast<void>(run(5000, 10, [&](const Frame& frame) {
    ++frames[frame.id];
    return true;
  }));
  EXPECT_EQ(frames[kMapHeaderId], 50);
  EXPECT_EQ(frames[kMapSlotsId], 100);
}

// WIRE-030: a change of one value makes one record go out again, and a new map come out.
TEST_F(LaneMapTest, OnlyChangesAreSent) {
  Map map = sample_map(20, 4, 10);
  sender_.update(map);
  static_cast<void>(run(3000));
  map.lanes[5].goal_distance_m += 10.0F;
  sender_.update(map);
  std::map<int, int> lanes;
  EXPECT_EQ(run(150, 10,
                [&](const Frame& frame) {
                  LaneRoute route;
                  if (decode(frame, route)) ++lanes[route.lane];
                  return true;
                }),
            1);
  EXPECT_TRUE(receiver_.map() == map);
  EXPECT_EQ(lanes[5], 1);
  EXPECT_LE(lanes.size(), 6U);  // the others: repetition, 30 records in 4.8 s, so at most 1 every 160 ms
}

// Half a step less than 0.1 m cannot be seen at the other end: no new revision, no new map.
TEST_F(LaneMapTest, WhatTheWireCannotShowIsNoChange) {
  Map map = sample_map(4, 3, 2);
  sender_.update(map);
  EXPECT_EQ(run(500), 1);
  map.lanes[1].goal_distance_m += 0.04F;
  sender_.update(map);
  EXPECT_EQ(run(5500), 0);
  EXPECT_TRUE(receiver_.confirmed());
}

// WIRE-030: while one record of the new map is missing, the old one stands and is not confirmed; the
// repetition brings it.
TEST_F(LaneMapTest, TheOldMapStandsUntilTheNewOneIsWhole) {
  const Map old_map = sample_map(10, 4, 8);
  sender_.update(old_map);
  static_cast<void>(run(1000));
  Map new_map = old_map;
  new_map.lanes[2] = sample_lane(6, 77);
  new_map.lanes[9].present = false;
  sender_.update(new_map);
  new_map.lanes[8].left = kNoLane;  // lane 9
  for (Lane& lane : new_map.lanes) {
    for (std::uint8_t& successor : lane.successors) successor = successor == 9 ? kNoLane : successor;
  }
  for (Conflict& conflict : new_map.conflicts) {
    if (conflict.first == 9 || conflict.second == 9) conflict = Conflict{};
  }
  bool dropped = false;
  EXPECT_EQ(run(200, 10,
                [&](const Frame& frame) {
                  LanePoint point;
                  const bool drop = !dropped && decode(frame, point) && point.lane == 2;
                  dropped = dropped || drop;
                  return !drop;
                }),
            0);
  ASSERT_TRUE(dropped);
  EXPECT_TRUE(receiver_.map() == old_map);
  EXPECT_FALSE(receiver_.confirmed());
  EXPECT_EQ(run(5000), 1);
  EXPECT_TRUE(receiver_.map() == new_map);
}

// WIRE-030: 16 revisions later the number is the same again. A receiver that missed all of them has records
// of the right revision with the wrong content: the digest tells, and the repetition puts it right.
TEST_F(LaneMapTest, RevisionsMayWrapUnseen) {
  Map map = sample_map(6, 4, 3);
  sender_.update(map);
  static_cast<void>(run(500));
  const Map before = map;
  for (int revision = 0; revision < 16; ++revision) {
    map.lanes[4] = sample_lane(4, 100 + revision);
    sender_.update(map);
    static_cast<void>(run(100, 10, [](const Frame& frame) {
      const bool of_lane_4 = frame.id >= kLaneHeaderId && frame.id <= kLanePointId && frame.data[1] >> 4 == 4;
      return !(of_lane_4 && (frame.data[2] & 0x3) == 0);
    }));
    EXPECT_TRUE(receiver_.map() == before);
  }
  EXPECT_EQ(run(5000), 1);
  EXPECT_TRUE(receiver_.map() == map);
}

std::uint16_t check_of(const Lane& lane, int slot, std::uint8_t revision) {
  std::uint16_t check = 0;
  for (int part = 0; part < part_count(lane); ++part) {
    Frame frame;
    EXPECT_TRUE(encode_part(lane, slot, revision, part, frame));
    check = static_cast<std::uint16_t>(check + frame_check(frame));
  }
  return check;
}

/// Makes a lane another one that adds as much to the digest. \return whether one was found
bool find_same_check(Lane& lane, int slot, std::uint8_t revision, std::uint8_t new_revision) {
  const std::uint16_t check = check_of(lane, slot, revision);
  for (int steps = 1; steps < 1'000'000; ++steps) {
    lane.goal_distance_m = 0.5F * static_cast<float>(steps % 1000);
    lane.route_remaining_m = 0.5F * static_cast<float>(steps / 1000);
    if (check_of(lane, slot, new_revision) == check) return true;
  }
  return false;
}

// WIRE-030: 16 bits are not many: two maps with the same digest are soon found. The header seems to confirm
// the old one until the revised record arrives.
TEST_F(LaneMapTest, ADigestThatHappensToBeTheSameIsNotTheEnd) {
  Map map = sample_map(2, 2, 0);
  sender_.update(map);
  static_cast<void>(run(500));
  ASSERT_TRUE(find_same_check(map.lanes[1], 1, 1, 2));
  sender_.update(map);
  EXPECT_EQ(run(100), 1);
  EXPECT_TRUE(receiver_.map() == map);
}

// WIRE-036: lanes 0 and 1 are revised; lane 1's record does not arrive, and its old one happens to add as much to the digest.
// New lane 0 with old lane 1 is a map that never was.
TEST_F(LaneMapTest, RecordsOfTwoMapsAreNoMapWhenTheirSumsAgree) {
  Map map = sample_map(2, 2, 0);
  sender_.update(map);
  static_cast<void>(run(500));
  const Map before = receiver_.map();
  map.lanes[0].goal_distance_m += 1.0F;
  ASSERT_TRUE(find_same_check(map.lanes[1], 1, 1, 2));
  sender_.update(map);
  EXPECT_EQ(run(1000, 10,
                [](const Frame& frame) {
                  return frame.id < kLaneHeaderId || frame.id > kLanePointId || frame.data[1] >> 4 != 1;
                }),
            0);
  EXPECT_TRUE(receiver_.map() == before);
  EXPECT_EQ(run(5000), 1);
  EXPECT_TRUE(receiver_.map() == map);
}

// WIRE-030: a lane revised while its record is on its way starts again; parts of both never make one lane.
TEST_F(LaneMapTest, ARecordRevisedHalfwayStartsAgain) {
  Map map = sample_map(3, 12, 0);
  sender_.update(map);
  static_cast<void>(run(500));
  for (int seed = 200; seed < 230; ++seed) {
    map.lanes[1] = sample_lane(12, seed);
    sender_.update(map);
    static_cast<void>(run(10, 7));
  }
  EXPECT_GE(run(200), 1);
  EXPECT_TRUE(receiver_.map() == map);
}

TEST_F(LaneMapTest, AnEmptyMapIsAMap) {
  sender_.update(Map{});
  EXPECT_EQ(run(300), 1);
  EXPECT_TRUE(receiver_.map() == Map{});
}

// Conflict slots 0 to 4 are in use; 1 to 3 are holes.
TEST_F(LaneMapTest, ConflictsKeepTheirSlots) {
  Map map = sample_map(4, 2, 0);
  map.conflicts[0] = sample_conflict(0, 1, 5);
  map.conflicts[4] = sample_conflict(2, 3, 6);
  sender_.update(map);
  EXPECT_EQ(run(300), 1);
  EXPECT_TRUE(receiver_.map() == map);
  map.conflicts[4] = Conflict{};
  sender_.update(map);
  EXPECT_EQ(run(300), 1);
  EXPECT_TRUE(receiver_.map() == map);
}

// WIRE-033: lane 1 has a point beyond 2097 m, lane 2 only one point, lane 3 a limit that is no number.
TEST_F(LaneMapTest, WhatDoesNotFitIsLeftOut) {
  Map map = sample_map(6, 3, 5);
  map.lanes_left_out = 3;
  map.lanes[1].x_m[2] = 2098.0F;
  map.lanes[2].point_count = 1;
  map.lanes[3].speed_limit_mps = std::numeric_limits<float>::quiet_NaN();
  map.lanes[4].stop_line_m = std::numeric_limits<float>::quiet_NaN();
  map.conflicts[4].first_entry_m = map.conflicts[4].first_exit_m + 1.0F;  // lanes 4 and 5
  map.conflicts[0] = sample_conflict(0, 5, 1);
  sender_.update(map);
  EXPECT_EQ(run(300), 1);
  const Map& arrived = receiver_.map();
  EXPECT_EQ(arrived.lanes_left_out, 3 + 4);
  for (int slot = 0; slot < kMaxLanes; ++slot) EXPECT_EQ(arrived.lanes[slot].present, slot == 0 || slot == 5);
  EXPECT_EQ(arrived.lanes[0].left, kNoLane);
  EXPECT_EQ(arrived.lanes[0].successors[0], kNoLane);
  EXPECT_EQ(arrived.lanes[5].right, kNoLane);
  for (int slot = 0; slot < kMaxConflicts; ++slot) EXPECT_EQ(arrived.conflicts[slot].present, slot == 0);
}

// WIRE-034: without headers the map stands but is not confirmed; with them it is again, and it is no new one.
TEST_F(LaneMapTest, SilenceEndsTheConfirmation) {
  sender_.update(sample_map(3, 2, 1));
  EXPECT_EQ(run(500), 1);
  receiver_.nothing_arrived();
  EXPECT_FALSE(receiver_.confirmed());
  EXPECT_EQ(run(100), 0);
  EXPECT_TRUE(receiver_.confirmed());
}

// A sender that starts anew begins with generation, revisions and counter at zero.
TEST_F(LaneMapTest, ANewSenderIsUnderstood) {
  sender_.update(sample_map(5, 4, 3));
  EXPECT_EQ(run(730), 1);
  sender_ = MapSender{};
  const Map sent = sample_map(5, 4, 3, 500);
  sender_.update(sent);
  EXPECT_EQ(run(1000), 1);
  EXPECT_TRUE(receiver_.map() == sent);
}

}  // namespace
}  // namespace s4tp::wire
