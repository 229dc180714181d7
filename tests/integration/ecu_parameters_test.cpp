/// Parameters and weights that the ECU takes, or refuses.

#include <gtest/gtest.h>

#include <vector>

#include "algo/core/parameter_info.hpp"
#include "algo/satp/shipped_weights.hpp"
#include "firmware/ecu/gate_limits.hpp"
#include "hal/sim/memory_flash_bank.hpp"
#include "tests/support/ecu_rig.hpp"
#include "tests/support/random_network.hpp"

namespace s4tp::ecu {
namespace {

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
