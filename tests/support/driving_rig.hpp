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

/// A plan straight on at 5 m/s, from the one in force.
inline void plan_straight_on(const planner::PlannerInput& input, Plan& plan) {
  Pose pose = input.running != nullptr ? sample(*input.running, input.start_ms).rear_axle
                                       : shift_ahead(input.ego.rear_axle, 5.0F * kStepS);
  for (TrajectoryPoint& point : plan.trajectory.points) {
    point.rear_axle = pose;
    point.speed_mps = 5.0F;
    pose = shift_ahead(pose, 5.0F * kStepS);
  }
}

}  // namespace s4tp::ecu
