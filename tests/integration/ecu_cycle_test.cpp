/// The two contexts, their timing, and what the ECU says on the bus.

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>
#include <vector>

#include "algo/satp/shipped_weights.hpp"
#include "firmware/ecu/gate_limits.hpp"
#include "firmware/ecu/plan_digest.hpp"
#include "hal/sim/memory_flash_bank.hpp"
#include "tests/support/ecu_rig.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::ecu {
namespace {

std::unique_ptr<Rig> driving_rig() {
  auto rig = std::make_unique<Rig>();
  EXPECT_EQ(rig->start(), Status::kOk);
  rig->plant.speed_mps = 5.0;
  EXPECT_TRUE(rig->drive());
  rig->seconds(0.5);
  return rig;
}

// ECU-075: at each boundary, and at no other tick, the plan changes to the one that was asked for it, whose
// start is that boundary.
TEST(EcuCycle, PlanTakesEffectExactlyAtItsBoundary) {
  const auto rig = driving_rig();
  int changes = 0;
  for (int i = 0; i < 100; ++i) {
    const std::uint32_t before_ms = rig->ecu.plan().start_ms;
    rig->tick();
    const std::uint32_t now_ms = rig->ecu.core().now_ms();
    if (rig->ecu.plan().start_ms == before_ms) {
      EXPECT_NE(now_ms % 100, 0U);
      continue;
    }
    EXPECT_EQ(now_ms % 100, 0U);
    EXPECT_EQ(rig->ecu.plan().start_ms, now_ms);
    EXPECT_EQ(rig->records.plans.back().computed_ms, now_ms - 100);
    EXPECT_EQ(rig->ecu.planner().seen.now_ms, now_ms);
    EXPECT_EQ(rig->ecu.planner().seen.start_ms, now_ms + 100);
    ++changes;
  }
  EXPECT_EQ(changes, 10);
}

// ECU-075: with stamps of 12 ms a boundary lies inside a tick; its first tick counts.
TEST(EcuCycle, BoundaryInsideATick) {
  const auto rig = driving_rig();
  rig->interval_ms = 12;
  for (int i = 0; i < 60; ++i) {
    const std::uint32_t before_ms = rig->ecu.core().now_ms();
    const std::uint32_t plan_ms = rig->ecu.plan().start_ms;
    rig->tick();
    const std::uint32_t now_ms = rig->ecu.core().now_ms();
    EXPECT_EQ(rig->ecu.plan().start_ms != plan_ms, before_ms / 100 != now_ms / 100);
  }
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
}

// In standby and ready the plan starts from the measured state (no running plan is given); driving, the
// running plan is carried on, and it is the one in force.
TEST(EcuCycle, RunningPlanOnlyWhileDriving) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  ASSERT_GE(rig.until(Mode::kReady), 0);
  rig.ticks(20);
  EXPECT_FALSE(rig.ecu.planner().had_running);
  EXPECT_TRUE(rig.ecu.planner().had_map);
  rig.engage = true;
  rig.ticks(20);
  EXPECT_TRUE(rig.ecu.planner().had_running);
}

// ECU-077: a vehicle appears on the bus; the planner then brakes. Whatever the phase, the command changes
// within 220 ms of the list, well below the 400 ms promised: up to 100 ms to the snapshot, 100 ms to the
// plan's boundary, and the tick itself.
TEST(EcuCycle, ObjectToCommandWithin400ms) {
  int worst = 0;
  for (int phase = 0; phase < 20; ++phase) {
    const auto rig = driving_rig();
    rig->ecu.planner().make = [](const planner::PlannerInput& input, Plan& plan) {
      for (int i = 0; i < kTrajectoryPoints; ++i) {
        TrajectoryPoint& point = plan.trajectory.points[i];
        const float ahead_s =
            static_cast<float>(input.start_ms - input.now_ms) / 1000.0F + kStepS * static_cast<float>(i);
        point.rear_axle = shift_ahead(input.ego.rear_axle, input.ego.speed_mps * ahead_s);
        point.speed_mps = input.ego.speed_mps;
        point.acceleration_mps2 = input.tracks.empty() ? 0.0F : -5.0F;
      }
    };
    rig->seconds(0.5);
    rig->ticks(phase);
    rig->track_list.count = 1;
    rig->track_list.items[0] = {7, 40.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 5.0F, 1.8F};
    // On the bus from the next list on: in ticks with number % 10 == 4.
    while (rig->number % 10 != 3) rig->tick();
    int ticks = 0;
    while (rig->command.acceleration_mps2 > -2.0F && ticks < 100) {
      rig->tick();
      ++ticks;
    }
    worst = std::max(worst, ticks);
  }
  EXPECT_LE(worst, 40);
  EXPECT_LE(worst, 22);
}

// ECU-076: a planner busy over three boundaries: each counts a miss, the late result is thrown away, the plan
// in force stays; afterwards plans come in time again.
TEST(EcuCycle, BusyPlanner) {
  const auto rig = driving_rig();
  while (rig->ecu.core().now_ms() % 100 != 0) rig->tick();
  rig->run_planner = false;
  rig->ticks(10);  // the plan made before takes effect here
  const std::uint32_t kept_ms = rig->ecu.plan().start_ms;
  EXPECT_EQ(kept_ms, rig->ecu.core().now_ms());
  const int cycles = rig->ecu.planner().cycles;
  rig->ticks(25);  // two boundaries without a plan
  EXPECT_EQ(rig->ecu.core().statistics().slips, 2U);
  rig->run_planner = true;
  rig->tick();  // finishes now, far too late
  EXPECT_EQ(rig->ecu.planner().cycles, cycles + 1);
  rig->ticks(4);
  EXPECT_EQ(rig->ecu.plan().start_ms, kept_ms);
  rig->ticks(10);
  EXPECT_EQ(rig->ecu.plan().start_ms, kept_ms + 400);
  EXPECT_EQ(rig->ecu.core().statistics().slips, 2U);
}

// ECU-076: a real overrun and an injected one give the same commands, tick by tick, to the bit.
TEST(EcuCycle, InjectedMissEqualsARealOne) {
  const auto real = driving_rig();
  const auto replay = driving_rig();
  for (const auto& rig : {real.get(), replay.get()}) {
    while (rig->ecu.core().now_ms() % 100 != 0) rig->tick();
  }
  for (int i = 0; i < 200; ++i) {
    if (i == 9) real->run_planner = false;  // the cycle of this boundary ends after the next one
    if (i == 25) real->run_planner = true;
    if (i == 12) replay->ecu.inject_deadline_miss();
    real->tick();
    replay->tick();
    ASSERT_EQ(real->command.acceleration_mps2, replay->command.acceleration_mps2) << i;
    ASSERT_EQ(real->command.steering_rad, replay->command.steering_rad) << i;
    ASSERT_EQ(real->digest, replay->digest) << i;
    ASSERT_EQ(real->ecu.mode(), replay->ecu.mode()) << i;
  }
  EXPECT_EQ(replay->ecu.core().statistics().slips, 1U);
  EXPECT_EQ(real->ecu.core().statistics().slips, 1U);
}

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

// ECU-064: against a plain CRC-32 over kind, start, 31 x 6 floats and the fail-safe's two, little endian.
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
  EXPECT_EQ(plan_digest(plan), plain_crc(bytes));
}

// ECU-090 ECU-091 ECU-092 ECU-093: parameters are taken in standby only, whole and valid; the planner gets
// them with the next snapshot.
TEST(EcuParameters, UpdateInStandby) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.ticks(50);
  ASSERT_EQ(rig.ecu.mode(), Mode::kStandby);
  const int inits = rig.ecu.planner().inits;
  Parameters parameters;
  parameters.comfort.headway_s = 2.0F;
  EXPECT_EQ(rig.ecu.update_parameters(parameters, parameters_crc(parameters) ^ 1U), UpdateResult::kWrongCrc);
  Parameters invalid = parameters;
  invalid.vehicle.wheelbase_m = 0.1F;
  EXPECT_EQ(rig.ecu.update_parameters(invalid, parameters_crc(invalid)), UpdateResult::kInvalid);
  rig.ticks(20);
  EXPECT_EQ(rig.ecu.planner().inits, inits);
  EXPECT_EQ(rig.ecu.update_parameters(parameters, parameters_crc(parameters)), UpdateResult::kTaken);
  rig.ticks(20);
  EXPECT_EQ(rig.ecu.planner().inits, inits + 1);
  rig.ticks(20);
  EXPECT_EQ(rig.ecu.planner().inits, inits + 1);
  ASSERT_GE(rig.until(Mode::kReady), 0);
  EXPECT_EQ(rig.ecu.update_parameters(parameters, parameters_crc(parameters)), UpdateResult::kNotNow);
}

// ECU-094: the default vehicle's limits are the gate's own; and at either end of every parameter's range they
// are such that the gate takes them.
TEST(EcuParameters, MakeTheGatesLimits) {
  const gate::Limits usual;
  const gate::Limits made = gate_limits(Parameters{});
  EXPECT_FLOAT_EQ(made.acceleration_max_mps2, usual.acceleration_max_mps2);
  EXPECT_FLOAT_EQ(made.braking_max_mps2, usual.braking_max_mps2);
  EXPECT_FLOAT_EQ(made.steering_max_rad, usual.steering_max_rad);
  EXPECT_FLOAT_EQ(made.steering_rate_max_radps, usual.steering_rate_max_radps);
  EXPECT_FLOAT_EQ(made.lateral_acceleration_max_mps2, usual.lateral_acceleration_max_mps2);
  EXPECT_FLOAT_EQ(made.wheelbase_m, usual.wheelbase_m);
  gate::CommandGate gate{usual};
  for (int i = 0; i < kParameterCount; ++i) {
    for (const float end : {parameter_info(i).minimum, parameter_info(i).maximum}) {
      Parameters parameters;
      set_parameter(parameters, i, end);
      EXPECT_TRUE(gate.set_limits(gate_limits(parameters))) << parameter_info(i).name;
    }
  }
}

// ECU-094: a plan's curve of 25 m at 10 m/s, 4 m/s^2, is let through to a vehicle of 6 m between its axles;
// one of 10 m, 10 m/s^2, is brought down to 6 m/s^2 for one of 1.5 m. (For 2.9 m the gate would cut the first
// at 2.9 m/s^2 and let the second have 11.) Set in standby, the limits hold as those given at the start do.
TEST(EcuParameters, TheGateGuardsTheVehicleTheyDescribe) {
  const auto most_lateral_mps2 = [](float wheelbase_m, float curvature_1pm, bool later) {
    Parameters parameters;
    parameters.vehicle.wheelbase_m = wheelbase_m;
    Rig rig;
    EXPECT_EQ(rig.start(later ? Parameters{} : parameters), Status::kOk);
    rig.ticks(20);
    if (later) {
      EXPECT_EQ(rig.ecu.update_parameters(parameters, parameters_crc(parameters)), UpdateResult::kTaken);
    }
    rig.plant.speed_mps = 10.0;
    rig.ecu.planner().make = [curvature_1pm](const planner::PlannerInput& input, Plan& plan) {
      for (int i = 0; i < kTrajectoryPoints; ++i) {
        TrajectoryPoint& point = plan.trajectory.points[i];
        point.rear_axle = shift_ahead(input.ego.rear_axle, static_cast<float>(i + 1));
        point.speed_mps = 10.0F;
        point.curvature_1pm = curvature_1pm;
      }
    };
    EXPECT_TRUE(rig.drive());
    double most_mps2 = 0.0;
    for (int i = 0; i < 50; ++i) {
      rig.tick();
      const double curvature =
          std::tan(static_cast<double>(rig.command.steering_rad)) / static_cast<double>(wheelbase_m);
      most_mps2 = std::max(most_mps2, curvature * rig.plant.speed_mps * rig.plant.speed_mps);
    }
    return most_mps2;
  };
  for (const bool later : {false, true}) {
    EXPECT_GT(most_lateral_mps2(6.0F, 0.04F, later), 3.2);
    EXPECT_NEAR(most_lateral_mps2(1.5F, 0.1F, later), 6.0, 0.1);
  }
}

// The whole loop: 10 s on the straight at 8 m/s with the planner carrying its own plan on: no fault, 2 cm
// beside.
TEST(EcuCycle, DrivesStraight) {
  const auto rig = driving_rig();
  rig->plant.y_m = 0.3;
  rig->ecu.planner().make = [](const planner::PlannerInput& input, Plan& plan) {
    const float from_m = input.running != nullptr ? sample(*input.running, input.start_ms).rear_axle.x_m
                                                  : input.ego.rear_axle.x_m;
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      plan.trajectory.points[i].rear_axle.x_m = from_m + 5.0F * kStepS * static_cast<float>(i);
      plan.trajectory.points[i].speed_mps = 5.0F;
    }
  };
  rig->seconds(10.0);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  EXPECT_NEAR(rig->plant.y_m, 0.0, 0.04);
  EXPECT_NEAR(rig->plant.speed_mps, 5.0, 0.05);
}

// ECU-072: frames 32.767 s apart bring vehicle time to 25 s before the end of its 32 bits. From there the car
// drives for 40 s, across the end: no fault, and each 100 ms the plan that was asked for.
TEST(EcuCycle, DrivesOnAcrossTheEndOfTime) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.steering = rig.pose = rig.tracks = rig.map = rig.version = false;
  rig.interval_ms = 32767;
  while (rig.ecu.core().now_ms() < 0xFFFFFFFFU - 25'000U - 32'767U) rig.tick();
  rig.steering = rig.pose = rig.tracks = rig.map = rig.version = true;
  rig.interval_ms = 10;
  while (rig.ecu.core().now_ms() < 0xFFFFFFFFU - 25'000U) rig.tick();
  rig.plant.speed_mps = 5.0;
  rig.seconds(3.0);  // the plausibility monitor forgets the jump (PLAUS-012)
  ASSERT_TRUE(rig.drive());
  rig.seconds(0.5);
  const std::uint32_t began_ms = rig.ecu.core().now_ms();
  for (int i = 0; i < 4000; ++i) {
    const std::uint32_t before_ms = rig.ecu.plan().start_ms;
    rig.tick();
    ASSERT_EQ(rig.ecu.faults(), 0) << i;
    ASSERT_EQ(rig.ecu.mode(), Mode::kDriving) << i;
    ASSERT_LT(rig.ecu.core().now_ms() - rig.ecu.plan().start_ms, 100U) << i;
    if (rig.ecu.plan().start_ms != before_ms) {
      ASSERT_EQ(rig.ecu.plan().start_ms, before_ms + 100U) << i;
    }
  }
  EXPECT_LT(rig.ecu.core().now_ms(), began_ms);
}

// The two contexts on two threads (run under the thread sanitizer too): plans arrive, and each in force starts at a
// boundary. The ticks wait for the planner after three boundaries of four, so that a busy machine shows this too: one
// left late costs its own plan and the next boundary's, so that two of four bring one, of 60 at least 20.
TEST(EcuCycle, TwoThreads) {
  Rig rig;
  ASSERT_EQ(rig.start(), Status::kOk);
  rig.plant.speed_mps = 5.0;
  rig.run_planner = false;
  std::atomic<bool> done{false};
  std::atomic<int> cycles{0};
  std::thread planning([&] {
    while (!done) {
      rig.ecu.planning_cycle();
      ++cycles;
      std::this_thread::yield();
    }
  });
  for (int i = 0; i < 600; ++i) {
    rig.engage = i > 300;
    rig.tick();
    // The second call from here on began after the last snapshot was given.
    const int enough = cycles + 2;
    while (i % 10 == 0 && i % 40 != 0 && cycles < enough) std::this_thread::yield();
  }
  done = true;
  planning.join();
  EXPECT_GE(rig.records.plans.size(), 20U);
  for (const PlanRecord& record : rig.records.plans) EXPECT_EQ(record.plan.start_ms % 100, 0U);
}

/// What the ECU tells about its weights while it drives.
struct Told {
  int weights = -1;
  int learned = 0;
  int reasons = 0;
};

Told drive_with(const hal::FlashBank* bank) {
  auto rig = std::make_unique<BasicRig<planner::Planner>>();
  EXPECT_EQ(rig->start({}, bank), Status::kOk);
  rig->plant.speed_mps = 5.0;
  EXPECT_TRUE(rig->drive());
  Told told;
  for (int i = 0; i < 200; ++i) {
    rig->tick();
    for (const wire::Frame& frame : rig->from_ecu) {
      wire::VersionEcu version;
      if (wire::decode(frame, version)) told.weights = version.weights;
      wire::PlanReason reason;
      if (!wire::decode(frame, reason)) continue;
      ++told.reasons;
      told.learned += reason.learned;
    }
  }
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  EXPECT_EQ(told.reasons, 20);
  return told;
}

// ECU-102 ECU-103 ECU-104 Weights from a flash bank: a sound image predicts; one that is cut off, damaged, of another
// format or size of network, or none at all is refused, the bus is told why, and the ECU drives on without it.
TEST(EcuWeights, WhatIsRefusedIsToldAndDrivenWithout) {
  std::vector<std::int32_t> image(satp::kImageBytes / 4);
  test::make_random_image(8, image.data());
  const auto told_of = [](const std::vector<std::int32_t>& words, std::size_t count) {
    const auto bank = std::make_unique<hal::sim::MemoryFlashBank>();
    EXPECT_TRUE(bank->write(0, words.data(), static_cast<std::uint32_t>(4 * count)));
    return drive_with(bank.get());
  };
  using satp::WeightStatus;
  const auto refused = [&](std::size_t word, std::int32_t flip, std::size_t count, WeightStatus expected) {
    std::vector<std::int32_t> other = image;
    other[word] ^= flip;
    const Told told = told_of(other, count);
    EXPECT_EQ(told.weights, static_cast<int>(expected)) << word;
    EXPECT_EQ(told.learned, 0) << word;
  };
  const Told sound = told_of(image, image.size());
  EXPECT_EQ(sound.weights, static_cast<int>(WeightStatus::kOk));
  EXPECT_EQ(sound.learned, sound.reasons);
  refused(0, 1, image.size(), WeightStatus::kNotWeights);
  refused(1, 2, image.size(), WeightStatus::kFormat);
  refused(3, 4, image.size(), WeightStatus::kChecksum);
  refused(5000, 1 << 30, image.size(), WeightStatus::kChecksum);
  refused(0, 0, image.size() / 2, WeightStatus::kChecksum);
  std::vector<std::int32_t> other_network = image;
  other_network[2] += 1;  // shape_id
  satp::seal(other_network.data());
  EXPECT_EQ(told_of(other_network, image.size()).weights, static_cast<int>(WeightStatus::kShape));
}

// ECU-102 Without a bank, and with a blank one, the weights are those the build carries.
TEST(EcuWeights, ABlankBankLeavesTheBuildsOwn) {
  const bool carried = satp::shipped_weights().image != nullptr;
  const auto blank = std::make_unique<hal::sim::MemoryFlashBank>();
  for (const hal::FlashBank* const bank :
       {static_cast<const hal::FlashBank*>(nullptr), static_cast<const hal::FlashBank*>(blank.get())}) {
    const Told told = drive_with(bank);
    EXPECT_EQ(told.weights,
              static_cast<int>(carried ? satp::WeightStatus::kOk : satp::WeightStatus::kAbsent));
    EXPECT_EQ(told.learned, carried ? told.reasons : 0);
  }
}

}  // namespace
}  // namespace s4tp::ecu
