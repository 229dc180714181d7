#pragma once
/// An ECU that drives, for tests of what then happens.

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/ecu_rig.hpp"

namespace s4tp::ecu {

/// One that has driven for half a second, at 5 m/s, without a fault.
inline std::unique_ptr<Rig> driving_rig() {
  auto rig = std::make_unique<Rig>();
  EXPECT_EQ(rig->start(), Status::kOk);
  rig->plant.speed_mps = 5.0;
  EXPECT_TRUE(rig->drive());
  rig->seconds(0.5);
  EXPECT_EQ(rig->ecu.mode(), Mode::kDriving);
  EXPECT_EQ(rig->ecu.faults(), 0);
  return rig;
}

}  // namespace s4tp::ecu
