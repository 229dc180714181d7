// The firmware's planner as a build without S4TP_LEARNED_PREDICTOR has it: what the network is worth is the difference
// between the two.

#include "sim_host/baselines/planner_registry.hpp"

namespace s4tp::baselines {
namespace {

template <bool kGuarded>
class KinematicPlanner final : public planner::PlanningCycle {
 public:
  KinematicPlanner() { (void)use_weights(nullptr, 0); }

 private:
  using planner::PlanningCycle::use_weights;  // no ECU's flash bank is for it either
  [[nodiscard]] safety::Verdict verify(int path, const Trajectory& trajectory) const override {
    return kGuarded ? planner::PlanningCycle::verify(path, trajectory) : safety::Verdict{};
  }
};

const RegisterPlanner kRegistered{{"s4tp_kinematic",
                                   "s4tp predicting with the kinematic model, not the network",
                                   ecu_with<KinematicPlanner<false>>, ecu_with<KinematicPlanner<true>>}};

}  // namespace
}  // namespace s4tp::baselines
