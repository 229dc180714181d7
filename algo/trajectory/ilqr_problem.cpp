#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::trajectory {

void reference_motion(const RefinementProblem& problem, Motion& motion) {
  motion.states[0] = problem.start;
  for (int i = 0; i < kHorizonSteps; ++i) {
    const MotionState& before = motion.states[i];
    const MotionState& reference = problem.steps[i].reference;
    motion.states[i + 1] = reference;
    motion.inputs[i] = {(reference.acceleration_mps2 - before.acceleration_mps2) / kStepS,
                        (reference.curvature_1pm - before.curvature_1pm) / kStepS};
  }
}

float Judgement::cost() const {
  return own + field;
}

}  // namespace s4tp::trajectory
