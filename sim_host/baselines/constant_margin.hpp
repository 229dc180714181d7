#pragma once
/// The S4TP planner with a constant margin in place of the risk field: the ablation that shows what the field is worth.
/// The weight of the risk is 0, and a plan passes only where our box keeps `safety.margin_m` from everybody's likeliest
/// future; whoever is nearer already comes no nearer. Candidates, predictor, price of expected touches and optimizer are
/// the same. Where no plan passes it brakes, as s4tp does.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

class ConstantMargin : public planner::PlanningCycle {
 public:
  [[nodiscard]] Status init(const Parameters& parameters);

 protected:
  /// \return kLeader with who is too near, else safe
  [[nodiscard]] safety::Verdict keeps_margin(const Trajectory& trajectory) const;

 private:
  Parameters without_field_;
};

template <bool kGuarded>
class ConstantMarginPlanner final : public ConstantMargin {
  [[nodiscard]] safety::Verdict verify(int path, const Trajectory& trajectory) const override {
    const safety::Verdict near = keeps_margin(trajectory);
    return kGuarded && near.safe() ? planner::PlanningCycle::verify(path, trajectory) : near;
  }
};

}  // namespace s4tp::baselines
