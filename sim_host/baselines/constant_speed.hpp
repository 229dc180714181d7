#pragma once
/// Holds the speed of the start and steers along the route, whoever is in the way.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

class ConstantSpeedPlanner {
 public:
  [[nodiscard]] Status init(const Parameters& parameters);
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation);

 private:
  Parameters parameters_;
  scene::SceneBuilder scene_builder_;
  scene::Scene scene_;
  float speed_mps_ = -1.0F;  ///< held; < 0: not seen yet
};

}  // namespace s4tp::baselines
