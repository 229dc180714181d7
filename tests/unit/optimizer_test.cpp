// The optimizer's place: what it gives is never worse than what it got.

#include "algo/trajectory/optimizer.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "algo/scene/scene.hpp"

namespace s4tp {
namespace {

// CAND-011 The identity: the trajectory comes back to the bit, after no iteration, at no cost.
TEST(Optimizer, GivesBackTheCandidate) {
  Trajectory trajectory;
  for (int i = 0; i < kTrajectoryPoints; ++i) trajectory.points[i].rear_axle.x_m = static_cast<float>(i);
  const Trajectory before = trajectory;
  const OptimizerResult result = optimize(Scene{}, PredictionSet{}, Parameters{}, 16, trajectory);
  EXPECT_EQ(std::memcmp(&before, &trajectory, sizeof(trajectory)), 0);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_LE(result.cost_after, result.cost_before);
}

}  // namespace
}  // namespace s4tp
