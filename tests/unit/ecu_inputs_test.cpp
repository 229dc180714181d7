#include <gtest/gtest.h>

#include "firmware/ecu/inputs.hpp"
#include "firmware/ecu/map_conversion.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

/// Inputs with senders; everything twice before a test begins, so that all protection is in step.
class Bench {
 public:
  Bench() {
    for (int i = 0; i < 3; ++i) {
      motion(10.0F);
      pose({});
      inputs.close_tick();
    }
  }
  void motion(float speed_mps, float acceleration_mps2 = 0.0F, float yaw_rate_radps = 0.0F) {
    wire::Motion message;
    message.vehicle_time_ms = static_cast<std::uint16_t>(stamp_ms += 10);
    message.speed_mps = speed_mps;
    message.acceleration_mps2 = acceleration_mps2;
    message.yaw_rate_radps = yaw_rate_radps;
    put(message, motion_sender);
  }
  void pose(const wire::Pose& message) { put(message, pose_sender); }
  void list(std::uint16_t at_ms, std::uint8_t count) {
    wire::Tracks tracks;
    tracks.vehicle_time_ms = at_ms;
    tracks.count = count;
    tracks.left_out = left_out;
    for (int i = 0; i < count; ++i)
      tracks.items[i] = {static_cast<std::uint8_t>(i + 1), 1.0F, 2.0F, 0.5F, 60.0F, -12.7F, 0.0F, 0.2F, 0.1F};
    track_sender.start(tracks);
    wire::Frame frame;
    while (track_sender.next(frame)) inputs.accept(frame);
  }
  template <class Message>
  void put(const Message& message, wire::E2eSender& sender) {
    wire::Frame frame;
    EXPECT_TRUE(wire::encode(message, frame));
    sender.protect(frame);
    inputs.accept(frame);
  }

  Inputs inputs;
  std::uint32_t stamp_ms = 1000;
  std::uint8_t left_out = 0;  ///< of lists
  wire::E2eSender motion_sender;
  wire::E2eSender pose_sender;
  wire::TrackListSender track_sender;
};

// ECU-061: a pose 50 ms old at 10 m/s along x is now 0.5 m on; the tick after, without a pose, 0.1 m more.
TEST(Inputs, BringsThePoseForward) {
  Bench bench;
  bench.motion(10.0F);
  wire::Pose pose;
  pose.x_m = 100.0F;
  pose.age_10ms = 5;
  bench.pose(pose);
  bench.inputs.close_tick();
  EXPECT_NEAR(bench.inputs.ego().rear_axle.x_m, 100.5F, 1e-4F);
  bench.motion(10.0F);
  bench.inputs.close_tick();
  EXPECT_NEAR(bench.inputs.ego().rear_axle.x_m, 100.6F, 1e-4F);
}

// ECU-061: turning with 0.5 rad/s for 40 ms turns by 0.02 rad, over a chord that points half of it: 0.4 *
// sin(0.01) = 4 mm to the left. Braking with 5 m/s^2, it was faster before: mean speed 10 + 5 * 0.04 / 2
// = 10.1 m/s.
TEST(Inputs, TurnsAndBrakesOnTheWay) {
  Bench bench;
  bench.motion(10.0F, 0.0F, 0.5F);
  wire::Pose pose;
  pose.age_10ms = 4;
  bench.pose(pose);
  bench.inputs.close_tick();
  EXPECT_NEAR(bench.inputs.ego().rear_axle.heading_rad, 0.02F, 1e-4F);
  EXPECT_NEAR(bench.inputs.ego().rear_axle.y_m, 0.004F, 1e-4F);
  bench.motion(10.0F, -5.0F, 0.0F);
  bench.pose(pose);
  bench.inputs.close_tick();
  EXPECT_NEAR(bench.inputs.ego().rear_axle.x_m, 0.404F, 1e-4F);
}

// ECU-062: 81 m/s, 20 m/s^2, 2.04 rad/s and 3 rad of steering come out as 60, 12, 2 and 0.8.
TEST(Inputs, BringsValuesIntoTheirRanges) {
  Bench bench;
  bench.motion(81.0F, 20.0F, 2.04F);
  wire::E2eSender sender;
  for (int i = 0; i < 2; ++i) {
    wire::Steering steering;
    steering.steering_rad = 3.0F;
    bench.put(steering, sender);
  }
  bench.inputs.close_tick();
  EXPECT_EQ(bench.inputs.ego().speed_mps, 60.0F);
  EXPECT_EQ(bench.inputs.ego().acceleration_mps2, 12.0F);
  EXPECT_EQ(bench.inputs.ego().yaw_rate_radps, 2.0F);
  EXPECT_EQ(bench.inputs.ego().steering_rad, 0.8F);
}

// ECU-063 ECU-062: a list counts with its own time; its tracks are brought into range, none is dropped. The
// same time again, or one from the future or over 1 s old, is refused.
TEST(Inputs, TakesOnlyNewPlausibleLists) {
  Bench bench;
  const auto tick = [&bench](std::uint32_t at_ms, std::uint8_t count) {
    bench.motion(10.0F);
    bench.list(static_cast<std::uint16_t>(at_ms), count);
    bench.inputs.close_tick();
  };
  tick(bench.stamp_ms, 0);  // the first header is not trusted yet
  tick(bench.stamp_ms, 2);
  ASSERT_EQ(bench.inputs.tracks().size(), 2);
  const std::uint32_t taken_ms = bench.inputs.tracks_ms();
  EXPECT_EQ(taken_ms, bench.stamp_ms - 10);
  EXPECT_EQ(bench.inputs.tracks()[1].id, 2);
  EXPECT_EQ(bench.inputs.tracks()[1].length_m, 0.5F);
  EXPECT_EQ(bench.inputs.tracks()[1].width_m, 0.3F);
  EXPECT_EQ(bench.inputs.tracks()[1].acceleration_mps2, -12.0F);
  const std::uint32_t rejected = bench.inputs.rejected_frames();
  tick(taken_ms, 3);
  tick(bench.stamp_ms + 500, 3);
  tick(bench.stamp_ms - 1100, 3);
  EXPECT_EQ(bench.inputs.tracks().size(), 2);
  EXPECT_EQ(bench.inputs.rejected_frames(), rejected + 3);
  tick(bench.stamp_ms, 1);
  EXPECT_EQ(bench.inputs.tracks().size(), 1);
}

// ECU-063 How many a list left out goes along with it, and no further.
TEST(Inputs, KnowsHowManyAListLeftOut) {
  Bench bench;
  for (const std::uint8_t left_out : {std::uint8_t{0}, std::uint8_t{3}, std::uint8_t{0}}) {
    bench.motion(10.0F);
    bench.left_out = left_out;
    bench.list(static_cast<std::uint16_t>(bench.stamp_ms), 2);
    bench.inputs.close_tick();
    EXPECT_EQ(bench.inputs.tracks().left_out, left_out);
  }
}

// A damaged frame changes nothing and is counted.
TEST(Inputs, CountsRejectedFrames) {
  Bench bench;
  const float speed_mps = bench.inputs.ego().speed_mps;
  wire::Motion message;
  message.speed_mps = 30.0F;
  wire::Frame frame;
  ASSERT_TRUE(wire::encode(message, frame));
  bench.motion_sender.protect(frame);
  frame.data[5] ^= 0x40U;
  const std::uint32_t rejected = bench.inputs.rejected_frames();
  bench.inputs.accept(frame);
  bench.inputs.close_tick();
  EXPECT_EQ(bench.inputs.ego().speed_mps, speed_mps);
  EXPECT_EQ(bench.inputs.rejected_frames(), rejected + 1);
  EXPECT_FALSE(bench.inputs.motion_fresh());
}

// ECU-060: lengths are sums of segments (3-4-5: 5 + 10); links and conflicts to lanes that are not there are
// cut, and so is a lane of no length.
TEST(MapConversion, ComputesLengthsAndCutsLooseEnds) {
  wire::Map from;
  for (const int slot : {2, 9, 11}) {
    wire::Lane& lane = from.lanes[slot];
    lane.present = true;
    lane.point_count = 3;
    lane.x_m[1] = 3.0F;
    lane.y_m[1] = 4.0F;
    lane.x_m[2] = 3.0F;
    lane.y_m[2] = 14.0F;
  }
  from.lanes[11].x_m[1] = from.lanes[11].x_m[2] = from.lanes[11].y_m[1] = from.lanes[11].y_m[2] = 0.0F;
  from.lanes[2].kind = 1;
  from.lanes[2].changes_needed = -2;
  from.lanes[2].successors[0] = 9;
  from.lanes[2].successors[1] = 11;
  from.lanes[2].successors[2] = 40;
  from.lanes[2].left = 9;
  from.conflicts[0] = {true, 2, 9, 1, 1.0F, 2.0F, 3.0F, 4.0F};
  from.conflicts[5] = {true, 2, 40, 0, 1.0F, 2.0F, 3.0F, 4.0F};
  from.lanes_left_out = 3;
  auto to = std::make_unique<LaneMap>();
  convert(from, *to);
  const Lane& lane = to->lanes[2];
  EXPECT_TRUE(lane.present);
  EXPECT_FLOAT_EQ(lane.length_m, 15.0F);
  EXPECT_EQ(lane.kind, LaneKind::kOpposite);
  EXPECT_EQ(lane.changes_needed, -2);
  EXPECT_EQ(lane.successors[0], 9);
  EXPECT_EQ(lane.successors[1], kNoLaneIndex);
  EXPECT_EQ(lane.successors[2], kNoLaneIndex);
  EXPECT_EQ(lane.left, 9);
  EXPECT_EQ(lane.right, kNoLaneIndex);
  EXPECT_FALSE(to->lanes[11].present);
  EXPECT_FALSE(to->lanes[0].present);
  ASSERT_EQ(to->conflicts.size(), 1);
  EXPECT_EQ(to->conflicts[0].priority, Priority::kFirstHasPriority);
  EXPECT_EQ(to->conflicts[0].second_exit_m, 4.0F);
  EXPECT_EQ(to->lanes_left_out, 3);
}

}  // namespace
}  // namespace s4tp::ecu
