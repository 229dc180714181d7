#pragma once
/// Prediction of other drivers (METHOD section 2): encode the scene once, then decode without our plan or for
/// a plan. The method behind it now is kinematic: each vehicle follows its lane paths by car-following (IDM)
/// and yields at conflict zones; conditioning makes our planned motion one more vehicle it reacts to.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

class Predictor {
 public:
  /// Reads the scene once; `scene` must outlive the following calls of this cycle.
  /// \param start_ms  plan start: the predictions' time zero; scene.time_ms <= start_ms
  void encode(const Scene& scene, const Parameters& parameters, std::uint32_t start_ms);

  /// Futures of the watched vehicles. \param plan  our motion from start_ms, or null: do not depend on us
  /// (we are then taken to keep our lane and speed only as far as we are already in their way).
  void decode(const Trajectory* plan, PredictionSet& prediction) const;

  /// "Keeps doing what it does": every agent along its likeliest path at constant speed.
  void keep_going(KinematicSet& prediction) const;

  /// Work done since encode(), in agent-mode-steps (the unit of the stage's allowance).
  [[nodiscard]] int work() const { return work_; }

 private:
  const Scene* scene_ = nullptr;
  const Parameters* parameters_ = nullptr;
  float lead_s_ = 0.0F;  ///< plan start minus scene time
  mutable int work_ = 0;
};

}  // namespace s4tp
