#pragma once
/// Static DRF (method.md 5): the S4TP planner, same candidates, risk field, score and optimizer, in
/// a world where every other vehicle stands.
///
/// Speed 0 in its tracks would not say that: the predictor lets who stands in a queue or before a junction
/// start, and the guard counts on it. So the scene itself is believed so: no speed, no past motion, no way to
/// go. Then every prediction of a vehicle, conditioned or not, is its present pose, and it arrives at no
/// conflict zone. Its present pose is that of the true track, brought forward to the scene's time.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

/// Guarded, it checks its candidates against the frozen world itself: a planner that does not would be
/// stopped by the guard around it where the same planner has a candidate that passes. The guard sees who
/// moves.
template <bool kGuarded>
class StaticDrfPlanner final : public planner::PlanningCycle {
 public:
  // No network: it was taught by drivers who move.
  StaticDrfPlanner() { (void)use_weights(nullptr, 0); }

 private:
  using planner::PlanningCycle::use_weights;  // no ECU's flash bank is for it either
  void believe(scene::Scene& scene) const override {
    // A vehicle that goes no way is predicted to stay, and to arrive nowhere.
    for (scene::Agent& agent : scene.agents) {
      agent.track.speed_mps = 0.0F;
      agent.track.acceleration_mps2 = 0.0F;
      agent.track.yaw_rate_radps = 0.0F;
      agent.coasted_m = 0.0F;
      agent.coasted_mps = 0.0F;
      agent.lane = kNoLaneIndex;
      agent.paths.clear();
      for (scene::History::Sample& sample : agent.history.samples) sample = {agent.track.centre, 0.0F};
    }
  }
  [[nodiscard]] safety::Verdict verify(int path, const Trajectory& trajectory) const override {
    return kGuarded ? planner::PlanningCycle::verify(path, trajectory) : safety::Verdict{};
  }
};

}  // namespace s4tp::baselines
