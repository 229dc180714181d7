#include "sim_host/world/nodes/vehicle_node.hpp"

#include <gtest/gtest.h>

namespace s4tp::nodes {
namespace {

wire::Frame command(double acceleration_mps2, wire::E2eSender& sender) {
  wire::Command message;
  message.acceleration_mps2 = static_cast<float>(acceleration_mps2);
  wire::Frame frame;
  EXPECT_TRUE(wire::encode(message, frame));
  sender.protect(frame);
  return frame;
}

class VehicleNodeTest : public testing::Test {
 protected:
  VehicleNodeTest() : node_({}, {0.0, 0.0}, 1) { node_.vehicle().place({0.0, 0.0}, 0.0, 10.0); }

  /// A tick in which this frame arrived.
  void drive(const wire::Frame& frame) {
    node_.receive(frame);
    node_.drive();
  }
  void drive_ticks(int count, double acceleration_mps2) {
    for (int i = 0; i < count; ++i) {
      drive(command(acceleration_mps2, sender_));
    }
  }

  VehicleNode node_;
  wire::E2eSender sender_;
};

// WORLD-002 Well protected commands are obeyed: 1 s of 2 m/s^2 gives about 2 m/s less what the lag costs.
TEST_F(VehicleNodeTest, ObeysProtectedCommands) {
  drive_ticks(100, 2.0);
  EXPECT_NEAR(node_.vehicle().speed_mps(), 11.7, 0.2);
}

// WORLD-002 With one bit flipped under the CRC the command changes nothing: the old one is held, then the car
// brakes.
TEST_F(VehicleNodeTest, RefusesDamagedCommands) {
  drive_ticks(50, 0.0);
  const double speed = node_.vehicle().speed_mps();
  for (int i = 0; i < 9; ++i) {
    wire::Frame frame = command(3.0, sender_);
    frame.data[4] ^= 0x10U;
    drive(frame);
  }
  EXPECT_NEAR(node_.vehicle().speed_mps(), speed, 1e-6);
}

// WORLD-002 A repeated counter is no new command.
TEST_F(VehicleNodeTest, RefusesRepeatedCommands) {
  drive_ticks(50, 0.0);
  const double speed = node_.vehicle().speed_mps();
  wire::E2eSender stuck = sender_;
  for (int i = 0; i < 40; ++i) {
    wire::E2eSender again = stuck;
    drive(command(3.0, again));
  }
  EXPECT_LT(node_.vehicle().speed_mps(), speed);
}

// WORLD-003 Silence for 100 ms and the car brakes by itself: 1 s later it has lost about (1 - 0.1 - lag) * 4
// = 3 m/s.
TEST_F(VehicleNodeTest, BrakesWithoutCommands) {
  drive_ticks(50, 0.0);
  const double speed = node_.vehicle().speed_mps();
  for (int i = 0; i < 9; ++i) {
    node_.drive();
  }
  EXPECT_NEAR(node_.vehicle().speed_mps(), speed, 1e-9);
  for (int i = 0; i < 91; ++i) {
    node_.drive();
  }
  EXPECT_NEAR(speed - node_.vehicle().speed_mps(), 3.0, 0.3);
  EXPECT_EQ(node_.silent_ticks(), 100);
}

// WORLD-004 Motion and Steering in each tick, Pose in every second one, each with a valid checksum.
TEST_F(VehicleNodeTest, PublishesItsState) {
  int poses = 0;
  for (std::uint32_t tick = 1; tick <= 10; ++tick) {
    std::vector<wire::Frame> frames;
    node_.publish(tick * 10, true, frames);
    ASSERT_GE(frames.size(), 2U);
    EXPECT_EQ(frames[0].id, wire::kMotionId);
    EXPECT_EQ(frames[1].id, wire::kSteeringId);
    poses += frames.size() == 3 && frames[2].id == wire::kPoseId;
    for (const wire::Frame& frame : frames) {
      EXPECT_TRUE(wire::e2e_crc_fits(frame));
    }
    wire::Motion motion;
    ASSERT_TRUE(wire::decode(frames[0], motion));
    EXPECT_EQ(motion.vehicle_time_ms, tick * 10);
    EXPECT_NEAR(motion.speed_mps, 10.0F, 0.003F);
  }
  EXPECT_EQ(poses, 5);
}

// The pose frame speaks of the rear axle, 1.5 m behind the box centre, and with a latency of 3 ticks says
// age 3.
TEST(VehicleNode, PoseIsTheRearAxleAndTellsItsAge) {
  SensorOptions sensors;
  sensors.pose_latency_ticks = 3;
  VehicleNode node(sensors, {100.0, 0.0}, 1);
  wire::Pose pose;
  for (std::uint32_t tick = 1; tick <= 8; ++tick) {
    node.vehicle().place({100.0 + tick, 0.0}, 0.0, 10.0);
    std::vector<wire::Frame> frames;
    node.publish(tick * 10, false, frames);
    if (tick % 2 == 0) {
      ASSERT_TRUE(wire::decode(frames[2], pose));
    }
  }
  EXPECT_EQ(pose.age_10ms, 3);
  EXPECT_NEAR(pose.x_m, 8.0F - 3.0F - 1.5F, 0.006F);
}

}  // namespace
}  // namespace s4tp::nodes
