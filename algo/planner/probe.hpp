#pragma once
/// A look inside a cycle, for measuring and for pictures. The planner works the same with or without one.

#include "algo/planner/explanation.hpp"
#include "algo/sadrf/risk.hpp"

namespace s4tp::planner {

/// What the candidates of a cycle were made from and what they cost: enough to roll each out again.
struct CandidatesView {
  const TrajectoryPoint& start;
  const Plan& running;
  const trajectory::ReferenceLines& lines;
  const trajectory::CandidateList& candidates;
  const CostBreakdown (&costs)[kMaxCandidates];  ///< of who was not rejected; risk 0 where none was computed
};

class Probe {
 public:
  virtual void stage_begin(Stage stage) = 0;
  virtual void stage_end(Stage stage) = 0;
  /// After the choice among them; not in a cycle without candidates. References end with the call.
  virtual void candidates_done(const CandidatesView&) {}
  /// The cycle's scene and what was predicted for the plan chosen, with its risk. References end with the
  /// call.
  virtual void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                          const sadrf::RiskProfile& risk) = 0;

 protected:
  ~Probe() = default;
};

}  // namespace s4tp::planner
