#pragma once
// Random scenes for tests of the risk of a trajectory.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "algo/core/math.hpp"
#include "algo/sadrf/risk.hpp"

namespace s4tp::test {

struct RiskWorld {
  scene::Scene scene;
  LaneMap map;
  satp::PredictionSet prediction;
  satp::KinematicSet others;
  Trajectory trajectory;
  Parameters parameters;
};

inline satp::Mode circle(const Pose& start, float speed_mps, float curvature_1pm, float probability) {
  satp::Mode mode;
  mode.probability = probability;
  Pose pose = start;
  for (Pose& step : mode.steps) {
    const float half = 0.5F * curvature_1pm * speed_mps * kStepS;
    pose.heading_rad = wrap_angle(pose.heading_rad + half);
    pose = shift_ahead(pose, speed_mps * kStepS);
    pose.heading_rad = wrap_angle(pose.heading_rad + half);
    step = pose;
  }
  return mode;
}

/// Our car on a circle along a bent road with an opposite lane, up to 8 others around it.
inline std::unique_ptr<RiskWorld> random_world(unsigned seed) {
  auto world = std::make_unique<RiskWorld>();
  std::mt19937 random(seed);
  const auto draw = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  const float speed = draw(0.0F, 14.0F);
  const float curvature = draw(-1.0F, 1.0F) * std::min(0.15F, 3.0F / (speed * speed + 1.0F));
  const satp::Mode own = circle({}, speed, curvature, 1.0F);
  for (int i = 0; i < kTrajectoryPoints; ++i) {
    TrajectoryPoint& point = world->trajectory.points[i];
    if (i > 0) point.rear_axle = own.steps[i - 1];
    point.speed_mps = speed;
    point.curvature_1pm = curvature;
  }
  for (int k = 0; k < 2; ++k) {
    Lane& lane = world->map.lanes[k];
    lane.present = true;
    lane.kind = k == 0 ? LaneKind::kOurs : LaneKind::kOpposite;
    lane.point_count = 3;
    const float y = 3.2F * static_cast<float>(k) + draw(-1.0F, 1.0F);
    lane.points[0] = {-30.0F, y};
    lane.points[1] = {30.0F, y};
    lane.points[2] = {90.0F, y + draw(-20.0F, 20.0F)};
  }
  const int count = std::uniform_int_distribution<int>(0, 8)(random);
  for (int i = 0; i < count; ++i) {
    scene::Agent agent;
    agent.track.centre = {draw(-40.0F, 60.0F), draw(-8.0F, 8.0F), draw(-3.1F, 3.1F)};
    agent.track.length_m = draw(3.5F, 12.0F);
    agent.track.width_m = draw(1.6F, 2.5F);
    const float its_speed = draw(0.0F, 14.0F);
    EXPECT_TRUE(world->scene.agents.push(agent));
    EXPECT_TRUE(world->others.agents.push(circle(agent.track.centre, its_speed, draw(-0.05F, 0.05F), 1.0F)));
    if (i < 3) {
      satp::AgentPrediction of;
      of.agent = static_cast<std::uint8_t>(i);
      const float first = draw(0.0F, 1.0F);
      EXPECT_TRUE(of.modes.push(circle(agent.track.centre, its_speed, draw(-0.1F, 0.1F), first)));
      EXPECT_TRUE(of.modes.push(circle(agent.track.centre, 0.5F * its_speed, 0.0F, 1.0F - first)));
      EXPECT_TRUE(world->prediction.agents.push(of));
    }
  }
  return world;
}

}  // namespace s4tp::test
