#include "sim_host/faults/faulty_bus.hpp"

#include <gtest/gtest.h>

#include "firmware/wire/codec.hpp"
#include "firmware/wire/e2e.hpp"
#include "firmware/wire/track_list.hpp"
#include "tests/support/sealed_frames.hpp"
#include "tests/support/wire_samples.hpp"

namespace s4tp::faults {
namespace {

using wire::Frame;

/// A vehicle that speeds up, and a list of two tracks, each tick.
class Sender {
 public:
  std::vector<Frame> tick(int tick) {
    std::vector<Frame> frames;
    wire::Motion motion;
    motion.vehicle_time_ms = static_cast<std::uint16_t>(10 * tick);
    motion.speed_mps = 0.1F * static_cast<float>(tick);
    frames.push_back(test::sealed(motion, motion_));
    wire::Pose pose;
    pose.x_m = static_cast<float>(tick);
    frames.push_back(test::sealed(pose, pose_));
    wire::TrackList list;
    list.count = 2;
    list.generation = static_cast<std::uint8_t>(tick % 16);
    frames.push_back(test::sealed(list, list_));
    return frames;
  }

 private:
  wire::E2eSender motion_;
  wire::E2eSender pose_;
  wire::E2eSender list_;
};

constexpr MessageSet kMotionBit = 1U << 0U;
constexpr MessageSet kPoseBit = 1U << 2U;
constexpr MessageSet kTrackListBit = 1U << 4U;
constexpr MessageSet kMembers = 3U << 5U;

FaultScript script_of(const Fault& fault) {
  FaultScript script;
  script.faults = {fault};
  return script;
}

/// What comes through of ticks 1 .. 30.
std::vector<std::vector<Frame>> through(const Fault& fault) {
  FaultyBus bus(script_of(fault));
  Sender sender;
  std::vector<std::vector<Frame>> result{{}};
  for (int tick = 1; tick <= 30; ++tick) result.push_back(bus.to_ecu(tick, sender.tick(tick)));
  return result;
}

int count(const std::vector<Frame>& frames, std::uint32_t id) {
  int found = 0;
  for (const Frame& frame : frames) found += frame.id == id ? 1 : 0;
  return found;
}

wire::Motion motion_in(const std::vector<Frame>& frames) {
  wire::Motion motion;
  for (const Frame& frame : frames) {
    EXPECT_TRUE(wire::e2e_crc_fits(frame));
    (void)wire::decode(frame, motion);
  }
  return motion;
}

// A loss of 100 % takes the message named, from its first tick to its last, and no other.
TEST(FaultyBus, LosesWhatItIsTold) {
  const auto ticks = through({FaultKind::kLoss, 10, 5, kPoseBit, 100, 1});
  for (int tick = 1; tick <= 30; ++tick) {
    const bool lost = tick >= 10 && tick < 15;
    EXPECT_EQ(count(ticks[static_cast<std::size_t>(tick)], wire::kPoseId), lost ? 0 : 1) << tick;
    EXPECT_EQ(count(ticks[static_cast<std::size_t>(tick)], wire::kMotionId), 1) << tick;
  }
}

// FAULT-003: half as long, a fault does the same to the ticks that are left; that is what lets a script be
// cut.
TEST(FaultyBus, ChoicesDoNotDependOnLength) {
  const auto all = through({FaultKind::kLoss, 5, 20, kPoseBit | kMotionBit, 50, 9});
  const auto tail = through({FaultKind::kLoss, 15, 10, kPoseBit | kMotionBit, 50, 9});
  int lost = 0;
  for (std::size_t tick = 15; tick <= 30; ++tick) {
    EXPECT_EQ(all[tick].size(), tail[tick].size()) << tick;
    lost += 3 - static_cast<int>(all[tick].size());
  }
  EXPECT_GT(lost, 0);
  EXPECT_LT(lost, 20);
}

// A delayed frame comes later, once, before that tick's own frames; none is lost, and then the fault is over.
TEST(FaultyBus, DelaysAndReturns) {
  const Fault fault{FaultKind::kDelay, 10, 5, kMotionBit, 3, 4};
  const auto ticks = through(fault);
  int total = 0;
  for (const auto& frames : ticks) total += count(frames, wire::kMotionId);
  EXPECT_EQ(total, 30);
  EXPECT_EQ(count(ticks[10], wire::kMotionId), 0);
  const FaultyBus bus(script_of(fault));
  EXPECT_FALSE(bus.over(17));  // 14 + 3
  EXPECT_TRUE(bus.over(18));
}

// A sender whose values are stuck counts and seals on: 0.1 x 10 = 1.0 m/s from tick 10 on, while time goes
// on.
TEST(FaultyBus, SticksUnderAValidCrc) {
  const auto ticks = through({FaultKind::kStuck, 10, 5, kMotionBit, 0, 1});
  EXPECT_FLOAT_EQ(motion_in(ticks[14]).speed_mps, 1.0F);
  EXPECT_EQ(motion_in(ticks[14]).vehicle_time_ms, 140);
  EXPECT_FLOAT_EQ(motion_in(ticks[15]).speed_mps, 1.5F);
  const auto dead_time = through({FaultKind::kStuck, 10, 5, kMotionBit, 1, 1});
  EXPECT_EQ(motion_in(dead_time[14]).vehicle_time_ms, 100);
  wire::E2eReceiver receiver;
  for (std::size_t tick = 1; tick <= 30; ++tick) (void)receiver.check(ticks[tick][0]);
  EXPECT_EQ(receiver.state(), wire::E2eState::kOk);
}

// Stamps 50 ms ahead for a jump; 4 ms a tick too short, so 4, 8, 12 ms behind, for early frames.
TEST(FaultyBus, ShiftsTheClock) {
  const auto jump = through({FaultKind::kClockJump, 10, 5, kMotionBit, 50, 1});
  EXPECT_EQ(motion_in(jump[12]).vehicle_time_ms, 170);
  EXPECT_EQ(motion_in(jump[15]).vehicle_time_ms, 150);
  const auto early = through({FaultKind::kEarlyMotion, 10, 5, kMotionBit, 4, 1});
  EXPECT_EQ(motion_in(early[10]).vehicle_time_ms, 96);
  EXPECT_EQ(motion_in(early[12]).vehicle_time_ms, 108);
}

// A pattern is sealed: the CRC cannot find it out. Some dice take the whole payload, some a part of it.
TEST(FaultyBus, PatternsAreSealed) {
  int changed = 0;
  for (std::uint32_t dice = 0; dice < 20; ++dice) {
    const auto ticks = through({FaultKind::kPattern, 10, 5, kMotionBit, 1, dice});
    EXPECT_TRUE(wire::e2e_crc_fits(ticks[12][0]));
    EXPECT_EQ(ticks[12][0].data[1] & 0x0F, 11);  // the counter of the twelfth frame
    changed += motion_in(ticks[12]).speed_mps > 80.0F ? 1 : 0;
  }
  EXPECT_GT(changed, 0);
}

// Damage is seen by the CRC or the length, always.
TEST(FaultyBus, DamageShows) {
  const auto ticks = through({FaultKind::kCorrupt, 1, 30, kMotionBit | kPoseBit | kTrackListBit, 100, 3});
  for (std::size_t tick = 1; tick <= 30; ++tick) {
    for (const Frame& frame : ticks[tick]) EXPECT_FALSE(frame.length == 8 && wire::e2e_crc_fits(frame));
  }
}

// A list of sixteen nonsense tracks: a header saying so and 32 members of its generation; a count beyond 16
// is out of the wire's range.
TEST(FaultyBus, MakesListsTooLong) {
  const auto full = through({FaultKind::kLongList, 10, 5, kTrackListBit, 1, 1});
  EXPECT_EQ(count(full[12], wire::kTrackPoseId), 16);
  EXPECT_EQ(count(full[12], wire::kTrackMotionId), 16);
  wire::TrackList list;
  EXPECT_TRUE(wire::decode(full[12][2], list));
  EXPECT_EQ(list.count, 16);
  const auto beyond = through({FaultKind::kLongList, 10, 5, kTrackListBit, 0, 1});
  EXPECT_TRUE(wire::e2e_crc_fits(beyond[12][2]));
  EXPECT_FALSE(wire::decode(beyond[12][2], list));
}

// FAULT-004: a list whose senders lie is a whole list all the same: its digest is that of what it says, and
// nothing of it is lost or comes twice.
TEST(FaultyBus, SealsListsOfLies) {
  wire::TrackListSender sender;
  wire::TrackListReceiver receiver;
  FaultyBus bus(script_of({FaultKind::kPattern, 1, 40, kMembers, 0, 9}));
  int lists = 0;
  int lies = 0;
  for (int list = 0; list < 4; ++list) {
    wire::Tracks tracks;
    tracks.count = 6;
    for (wire::Track& track : tracks.items) track = {1, 10.0F, 2.0F, 0.0F, 5.0F, 0.0F, 0.0F, 4.5F, 1.8F};
    sender.start(tracks);
    for (int tick = 10 * list + 1; tick <= 10 * list + 10; ++tick) {
      std::vector<Frame> frames;
      Frame frame;
      for (int i = 0; i < 2 && sender.next(frame); ++i) frames.push_back(frame);
      for (const Frame& passed : bus.to_ecu(tick, frames)) {
        if (!receiver.accept(passed)) continue;
        ++lists;
        lies += receiver.tracks() == tracks ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(receiver.voided_lists(), 0);
  EXPECT_EQ(lists, 3);
  EXPECT_EQ(lies, 3);
}

// The controller's state, and late plans, only while the fault lasts; off goes before passive.
TEST(FaultyBus, ControllerAndPlanner) {
  FaultScript script = script_of({FaultKind::kBusOff, 10, 5, 0, 0, 1});
  script.faults.push_back({FaultKind::kBusOff, 12, 5, 0, 2, 1});
  script.faults.push_back({FaultKind::kLatePlan, 12, 5, 0, 100, 1});
  const FaultyBus bus(script);
  EXPECT_EQ(bus.controller(9), hal::CanState::kActive);
  EXPECT_EQ(bus.controller(14), hal::CanState::kBusOff);
  EXPECT_EQ(bus.controller(15), hal::CanState::kPassive);
  EXPECT_FALSE(bus.plan_late(11));
  EXPECT_TRUE(bus.plan_late(16));
}

// Loss strikes commands on their way back too; faults of the world's senders do not.
TEST(FaultyBus, OtherDirection) {
  wire::Command command;
  Frame frame;
  ASSERT_TRUE(wire::encode(command, frame));
  FaultyBus loses(script_of({FaultKind::kLoss, 1, 5, 1U << 17U, 100, 1}));
  EXPECT_TRUE(loses.to_world(3, {frame}).empty());
  EXPECT_EQ(loses.to_world(6, {frame}).size(), 1U);
  FaultyBus babbles(script_of({FaultKind::kBabble, 1, 5, kMotionBit, 60, 1}));
  EXPECT_EQ(babbles.to_world(3, {frame}).size(), 1U);
}

}  // namespace
}  // namespace s4tp::faults
