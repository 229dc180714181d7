#include "algo/satp/prediction.hpp"

#include "algo/core/inline.hpp"

namespace s4tp::satp {

void measure_steps(Mode& mode) {
  float longest_m2 = 0.0F;
  for (int i = 1; i < kHorizonSteps; ++i) {
    const Point moved = position(mode.steps[i]) - position(mode.steps[i - 1]);
    longest_m2 = max(longest_m2, dot(moved, moved));
  }
  // One more than the nearest: an upper bound.
  mode.longest_step_cm = static_cast<std::uint16_t>(to_int(100.0F * sqrt(longest_m2) + 1.0F, 0, 65535));
}

void likeliest_first(AgentPrediction& futures) {
  int best = 0;
  for (int i = 1; i < futures.modes.size(); ++i) {
    if (futures.modes[i].probability > futures.modes[best].probability) best = i;
  }
  if (best == 0) return;
  const Mode first = futures.modes[0];
  futures.modes[0] = futures.modes[best];
  futures.modes[best] = first;
}

}  // namespace s4tp::satp
