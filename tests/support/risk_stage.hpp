#pragma once
/// A scene for the risk of a trajectory, set up by hand.

#include <gtest/gtest.h>

#include <memory>

#include "algo/core/math.hpp"
#include "algo/sadrf/risk.hpp"

namespace s4tp::sadrf {

/// A scene with everything the risk needs, and shorthand to fill it.
struct RiskStage {
  scene::Scene scene;
  LaneMap map;
  DrivableArea area;
  satp::PredictionSet prediction;
  satp::KinematicSet others;
  Trajectory trajectory;
  Parameters parameters;
  RiskProfile profile;

  /// Our car straight along y = `y_m` from x = 0.
  void drive(float speed_mps, float y_m = 0.0F) {
    for (int i = 0; i < kTrajectoryPoints; ++i) {
      TrajectoryPoint& point = trajectory.points[i];
      point = TrajectoryPoint{};
      point.rear_axle = {speed_mps * kStepS * static_cast<float>(i), y_m, 0.0F};
      point.speed_mps = speed_mps;
    }
  }

  static satp::Mode straight(const Pose& start, float speed_mps, float probability) {
    satp::Mode mode;
    mode.probability = probability;
    for (int i = 0; i < kHorizonSteps; ++i) {
      mode.steps[i] = shift_ahead(start, speed_mps * kStepS * static_cast<float>(i + 1));
    }
    return mode;
  }

  /// A 5 x 1.8 m car, straight on at constant speed. \return its index
  int add_car(const Pose& centre, float speed_mps) {
    scene::Agent agent;
    agent.track.centre = centre;
    agent.track.speed_mps = speed_mps;
    agent.track.length_m = 5.0F;
    agent.track.width_m = 1.8F;
    EXPECT_TRUE(scene.agents.push(agent));
    EXPECT_TRUE(others.agents.push(straight(centre, speed_mps, 1.0F)));
    return scene.agents.size() - 1;
  }

  /// Gives agent `index` two predicted futures instead of its kinematic one.
  void predict(int index, const satp::Mode& one, const satp::Mode& two) {
    satp::AgentPrediction of;
    of.agent = static_cast<std::uint8_t>(index);
    EXPECT_TRUE(of.modes.push(one));
    EXPECT_TRUE(of.modes.push(two));
    EXPECT_TRUE(prediction.agents.push(of));
  }

  void add_lane(int index, LaneKind kind, Point from, Point to, float width_m = 3.2F) {
    Lane& lane = map.lanes[index];
    lane.present = true;
    lane.kind = kind;
    lane.width_m = width_m;
    lane.point_count = 2;
    lane.points[0] = from;
    lane.points[1] = to;
    lane.length_m = distance(from, to);
  }

  void know_the_road() { build_drivable(&map, area); }

  const RiskProfile& exact() {
    exact_risk(scene, area, prediction, others, trajectory, parameters, profile);
    return profile;
  }

  float rank() {
    WorkMeter work{1'000'000};
    return rank_risk_of_vehicles(scene, prediction, others, trajectory, parameters, work) +
           rank_risk_of_road(area, trajectory, parameters, work);
  }
};

/// Our lane along x with an opposite one to its left, both 3.2 m wide.
inline void two_way_road(RiskStage& stage) {
  stage.add_lane(0, LaneKind::kOurs, {-50.0F, 0.0F}, {250.0F, 0.0F});
  stage.add_lane(1, LaneKind::kOpposite, {250.0F, 3.2F}, {-50.0F, 3.2F});
  stage.know_the_road();
}

inline std::unique_ptr<RiskStage> stage_with_straight_drive(float speed_mps) {
  auto stage = std::make_unique<RiskStage>();
  stage->drive(speed_mps);
  return stage;
}

}  // namespace s4tp::sadrf
