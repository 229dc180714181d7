#include "algo/planner/explanation.hpp"

namespace s4tp::planner {

float CostBreakdown::total() const {
  return progress + speed + jerk + lateral + lane + risk;
}

ExpectedFuture expected_future(const satp::PredictionSet& prediction, int agent) {
  ExpectedFuture expected;
  for (const satp::AgentPrediction& futures : prediction.agents) {
    if (futures.agent != agent) continue;
    expected.yields = futures.modes[0].yields;
    for (const satp::Mode& mode : futures.modes) {
      if (mode.yields == expected.yields) expected.probability += mode.probability;
    }
  }
  return expected;
}

}  // namespace s4tp::planner
