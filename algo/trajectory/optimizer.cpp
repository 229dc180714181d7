#include "algo/trajectory/optimizer.hpp"

namespace s4tp {

OptimizerResult optimize(const Scene& /*scene*/, const PredictionSet& /*prediction*/,
                         const Parameters& /*parameters*/, int /*allowance*/, Trajectory& /*trajectory*/) {
  return {};
}

}  // namespace s4tp
