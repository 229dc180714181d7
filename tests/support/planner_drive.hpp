#pragma once
/// A planner that drives by its own plans.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "algo/planner/planner.hpp"
#include "algo/trajectory/bicycle.hpp"
#include "algo/trajectory/plan_limits.hpp"
#include "tests/support/lane_maps.hpp"

namespace s4tp::test {

/// A planner that is driven at its own planned state, 100 ms a cycle.
class PlannerDrive {
 public:
  explicit PlannerDrive(LaneMap map, const Parameters& with = {})
      : parameters(with), map_(std::make_unique<LaneMap>(std::move(map))) {
    EXPECT_EQ(planner->init(parameters), Status::kOk);
    input.start_ms = 100;
  }

  Status step() {
    input.map = has_map ? map_.get() : nullptr;
    input.running = &running;
    Plan next;
    const Status status = planner->plan(input, next, explanation);
    running = next;
    EXPECT_TRUE(trajectory::keeps_limits(running.trajectory, parameters)) << input.now_ms;  // CAND-020
    input.now_ms += 100;
    input.start_ms += 100;
    input.tracks_ms = input.now_ms;
    const TrajectoryPoint now = sample(running, input.now_ms);
    input.ego = {now.rear_axle, now.speed_mps, now.acceleration_mps2, now.speed_mps * now.curvature_1pm,
                 std::atan(2.9F * now.curvature_1pm)};
    for (Track& track : input.tracks) track.centre = shift_ahead(track.centre, 0.1F * track.speed_mps);
    return status;
  }

  Parameters parameters;
  bool has_map = true;
  std::unique_ptr<planner::Planner> planner = std::make_unique<planner::Planner>();
  planner::PlannerInput input;
  Plan running;
  planner::Explanation explanation;

 private:
  std::unique_ptr<LaneMap> map_;
};

inline PlannerDrive on_straight_road(float speed_mps, const Parameters& parameters = {}) {
  PlannerDrive drive(straight_road(3, 400.0F), parameters);
  drive.input.ego.rear_axle = {20.0F, 0.0F, 0.0F};
  drive.input.ego.speed_mps = speed_mps;
  return drive;
}

}  // namespace s4tp::test
