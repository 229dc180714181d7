#pragma once
/// What a planner makes of one instant.

#include <gtest/gtest.h>

#include <memory>

#include "algo/planner/planner.hpp"

namespace s4tp::test {

/// The first plan of a planner that is made for it, with one other vehicle.
template <class PlannerT>
Plan first_plan(const LaneMap& map, const EgoState& ego, const Track& other,
                const Parameters& parameters = {}) {
  const auto planner = std::make_unique<PlannerT>();
  EXPECT_EQ(planner->init(parameters), Status::kOk);
  planner::PlannerInput input;
  input.map = &map;
  input.start_ms = 100;
  input.ego = ego;
  (void)input.tracks.push(other);
  Plan plan;
  planner::Explanation explanation;
  EXPECT_EQ(planner->plan(input, plan, explanation), Status::kOk);
  return plan;
}

}  // namespace s4tp::test
