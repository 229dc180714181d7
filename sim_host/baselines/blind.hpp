#pragma once
/// A driver who sees the road and nobody on it: the S4TP planner with every track withheld. The measure of
/// how dangerous the traffic is.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

class BlindPlanner {
 public:
  [[nodiscard]] Status init(const Parameters& parameters) { return planner_.init(parameters); }
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation);
  [[nodiscard]] planner::Planner& inner() { return planner_; }

 private:
  planner::Planner planner_;
};

}  // namespace s4tp::baselines
