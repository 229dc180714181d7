#pragma once
/// Static DRF (method.md 5): the S4TP planner, same candidates, risk field, score and optimizer, in
/// a world where every other vehicle stands.
///
/// Speed 0 in its tracks would not say that: the predictor lets who stands in a queue or before a junction
/// start, and the guard counts on it. So the planner itself is told (Planner::others_stand),
/// once the scene is built: no speed, no past motion, no way to go. Then every prediction of a vehicle,
/// conditioned or not, is its present pose, and it arrives at no conflict zone. Its present pose is that of
/// the true track, brought forward to the scene's time.

#include "algo/planner/planner.hpp"

namespace s4tp::baselines {

/// Guarded, it checks its candidates against the frozen world itself: a planner that does not would be
/// stopped by the guard around it where the same planner has a candidate that passes. The guard sees who
/// moves.
template <bool kGuarded>
class StaticDrfPlanner : public Planner {
 public:
  StaticDrfPlanner() {
    guarded = kGuarded;
    others_stand = true;
  }
};

}  // namespace s4tp::baselines
