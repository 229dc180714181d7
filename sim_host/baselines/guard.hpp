#pragma once
/// The guard around somebody else's plan: verdict and fail-safe, as the S4TP planner has them inside. Every planner is compared with it and without (method.md 4).
///
/// It sees the tracks as they are, whatever its planner makes of them. A plan that does not pass is replaced
/// by the fail-safe of the last one that did. An
/// infeasible trajectory does not pass, so a planner that wants its plans driven keeps to feasible()
/// (bicycle.hpp).

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

class Guard {
 public:
  [[nodiscard]] Status init(const Parameters& parameters);
  /// \param status  what the planner said of `plan`; anything but kOk is a plan that does not pass
  /// \return kOk, or why the plan is now the minimum-risk manoeuvre: `status`, kNoLane, kNoSafePlan
  [[nodiscard]] Status apply(const planner::PlannerInput& input, Status status, Plan& plan,
                             planner::Explanation& explanation);

 private:
  Parameters parameters_;
  scene::SceneBuilder scene_builder_;
  scene::Scene scene_;
  safety::Guard guard_;
};

/// A planner with the guard behind it; a planner itself.
template <class PlannerT>
class Guarded {
 public:
  [[nodiscard]] Status init(const Parameters& parameters) {
    const Status status = planner_.init(parameters);
    return status == Status::kOk ? guard_.init(parameters) : status;
  }
  [[nodiscard]] Status plan(const planner::PlannerInput& input, Plan& plan,
                            planner::Explanation& explanation) {
    const Status status = planner_.plan(input, plan, explanation);
    return guard_.apply(input, status, plan, explanation);
  }
  [[nodiscard]] PlannerT& inner() { return planner_; }

 private:
  PlannerT planner_;
  Guard guard_;
};

}  // namespace s4tp::baselines
