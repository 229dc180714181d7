/// What the ECU says on the bus.

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "firmware/ecu/plan_digest.hpp"
#include "tests/support/driving_rig.hpp"
#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {
namespace {

// ECU-065: after a command nothing more comes in its tick, be it one with status, statistics or version.
TEST(EcuReports, CommandIsTheLastFrameOfItsTick) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  std::size_t most = 0;
  for (int i = 0; i < 120; ++i) {
    rig.tick();
    ASSERT_FALSE(rig.from_ecu.empty());
    EXPECT_EQ(rig.from_ecu.back().id, wire::kCommandId) << i;
    most = std::max(most, rig.from_ecu.size());
  }
  EXPECT_GE(most, 2U);
}

// ECU-065: each tick one command, echoing its number and the count of frames taken, both modulo 4096.
TEST(EcuReports, CommandEchoes) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.number = 4090;
  for (int i = 0; i < 20; ++i) {
    rig.tick();
    int commands = 0;
    for (const wire::Frame& frame : rig.from_ecu) commands += frame.id == wire::kCommandId ? 1 : 0;
    EXPECT_EQ(commands, 1);
    if (i > 0) {  // the first TICK frame is not trusted yet
      EXPECT_EQ(rig.command.tick, rig.number & 0xFFF);
    }
    EXPECT_EQ(rig.command.accepted, rig.ecu.core().inputs().accepted_frames() & 0xFFFU);
    EXPECT_EQ(rig.watchdog.kicks(), static_cast<std::uint32_t>(i + 1));
  }
  EXPECT_EQ(rig.ecu_port->counters().received, rig.ecu.core().inputs().accepted_frames());
}

// ECU-066 ECU-067 ECU-068 ECU-069: in 10 s 100 status frames, 10 statistics, 10 versions, and with a plan
// each 100 ms 100 digests and reasons; all protected, at the rates of the DBC.
TEST(EcuReports, Rates) {
  const auto rig = driving_rig();
  std::map<std::uint32_t, int> count;
  std::map<std::uint32_t, wire::E2eReceiver> receivers;
  int untrusted = 0;
  for (int i = 0; i < 1000; ++i) {
    rig->tick();
    for (const wire::Frame& frame : rig->from_ecu) {
      if (++count[frame.id] > 1 && !wire::E2eReceiver::trusted(receivers[frame.id].check(frame))) ++untrusted;
      if (count[frame.id] == 1) (void)receivers[frame.id].check(frame);
    }
  }
  EXPECT_EQ(untrusted, 0);
  EXPECT_EQ(count[wire::kCommandId], 1000);
  for (const std::uint32_t id : {wire::kEcuStatusId, wire::kPlanDigestId, wire::kPlanReasonId})
    EXPECT_EQ(count[id], 100);
  for (const std::uint32_t id : {wire::kCycleStatisticsId, wire::kVersionEcuId}) EXPECT_EQ(count[id], 10);
  for (const auto& [id, frames] : count) {
    for (const wire::MessageInfo& message : wire::kMessages) {
      if (message.id == id) {
        EXPECT_EQ(frames * message.cycle_ms, 10000) << message.name;
      }
    }
  }
}

// ECU-064 ECU-069: the digest on the bus is that of the plan in force. One bit of any field changes it, and
// so do start and kind.
TEST(EcuReports, Digest) {
  const auto rig = driving_rig();
  EXPECT_EQ(rig->digest, plan_digest(rig->ecu.plan()));
  EXPECT_EQ(rig->records.plans.back().digest, rig->digest);
  const Plan plan = rig->ecu.plan();
  const std::uint32_t digest = plan_digest(plan);
  Plan other = plan;
  other.trajectory.points[30].curvature_1pm += 1e-7F;
  EXPECT_NE(plan_digest(other), digest);
  other = plan;
  other.start_ms ^= 1U;
  EXPECT_NE(plan_digest(other), digest);
  other = plan;
  other.kind = PlanKind::kMinimumRisk;
  EXPECT_NE(plan_digest(other), digest);
  other = plan;
  other.manoeuvre.side = -1;
  EXPECT_NE(plan_digest(other), digest);
}

/// CRC-32 as everybody computes it, a bit at a time.
std::uint32_t plain_crc(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

// ECU-064: against a plain CRC-32 over kind, start, 31 x 6 floats, the fail-safe's two and what was decided,
// little endian.
TEST(EcuReports, DigestIsCrc32) {
  Plan plan;
  plan.kind = PlanKind::kDrive;
  plan.start_ms = 0x12345678;
  std::vector<std::uint8_t> bytes = {1, 0, 0, 0, 0x78, 0x56, 0x34, 0x12};
  float value = 0.5F;
  for (TrajectoryPoint& point : plan.trajectory.points) {
    for (float* field : {&point.rear_axle.x_m, &point.rear_axle.y_m, &point.rear_axle.heading_rad,
                         &point.speed_mps, &point.acceleration_mps2, &point.curvature_1pm}) {
      *field = value;
      value *= -1.25F;
      if (std::abs(value) > 1e6F) value = 0.01F;
      std::uint32_t bits = 0;
      std::memcpy(&bits, field, 4);
      for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
    }
  }
  plan.fail_safe = {0.5F, 6.0F};
  for (const std::uint8_t byte : {0x00, 0x00, 0x00, 0x3f, 0x00, 0x00, 0xc0, 0x40}) bytes.push_back(byte);
  plan.manoeuvre = {
      LaneChange::kCrossing, -1, RequiredChange::kApproaching, ZoneClaim::kCommitted, 1, 2, 3, 4};
  for (const std::uint8_t byte : {2, 0xFF, 1, 2, 1, 0, 2, 0, 3, 0, 4, 0}) bytes.push_back(byte);
  EXPECT_EQ(plan_digest(plan), plain_crc(bytes));
}

}  // namespace
}  // namespace s4tp::ecu
