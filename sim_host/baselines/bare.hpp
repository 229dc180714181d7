#pragma once
/// The S4TP planner without its guard: the score alone decides among feasible candidates. Shows what the guard
/// saves and costs.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

class BarePlanner final : public planner::PlanningCycle {
  [[nodiscard]] safety::Verdict verify(int, const Trajectory&) const override { return {}; }
};

}  // namespace s4tp::baselines
