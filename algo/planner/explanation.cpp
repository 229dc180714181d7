#include "algo/planner/explanation.hpp"

namespace s4tp::planner {

float CostBreakdown::total() const {
  return progress + speed + jerk + lateral + lane + risk;
}

ExpectedFuture expected_future(const satp::PredictionSet& prediction, int agent) {
  ExpectedFuture expected;
  for (const satp::AgentPrediction& futures : prediction.agents) {
    if (futures.agent != agent) continue;
    float yields = 0.0F;
    for (const satp::Mode& mode : futures.modes)
      yields += 0.01F * static_cast<float>(mode.yields_percent) * mode.probability;
    expected.yields = yields > 0.5F;
    expected.probability = expected.yields ? yields : 1.0F - yields;
  }
  return expected;
}

}  // namespace s4tp::planner
