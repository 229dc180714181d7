#pragma once
/// A look inside a cycle, for measuring and for pictures. The planner works the same with or without one.

#include "algo/planner/explanation.hpp"
#include "algo/sadrf/risk.hpp"

namespace s4tp {

class Probe {
 public:
  virtual void stage_begin(Stage stage) = 0;
  virtual void stage_end(Stage stage) = 0;
  /// The cycle's scene and what was predicted for the plan chosen, with its risk. References end with the
  /// call.
  virtual void cycle_done(const Scene& scene, const PredictionSet& prediction, const RiskProfile& risk) = 0;

 protected:
  ~Probe() = default;
};

}  // namespace s4tp
