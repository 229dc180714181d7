#pragma once
/// Refinement of the chosen candidate (METHOD 4.5). The method behind it now is the identity: the best scored
/// candidate itself. Its interface is final: never worse than its start (CAND-011), within 1.0 m and 0.5 s of
/// it.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

struct OptimizerResult {
  int iterations = 0;
  float cost_before = 0.0F;
  float cost_after = 0.0F;
};

/// \param trajectory  in: the chosen candidate; out: the refined one, same start
/// \param allowance   most iterations
[[nodiscard]] OptimizerResult optimize(const Scene& scene, const PredictionSet& prediction,
                                       const Parameters& parameters, int allowance, Trajectory& trajectory);

}  // namespace s4tp
