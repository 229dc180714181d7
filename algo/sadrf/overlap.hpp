#pragma once
/// Predicted overlap of boxes: the crash term of a score, apart from the field (method.md 3: a vehicle
/// that stands across a lane has no ego-side risk).

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::sadrf {

/// How likely the trajectory touches a vehicle with this future within the horizon. A future knows better where a vehicle
/// drives than when: after `t` it may be as far on as at any time within scoring.timing_error * t of `t`, the less likely
/// the further off. One that stands, or stops before our way, is not off at all. A vehicle that touches us from the first
/// step on counts when it is 0.3 m deeper. \return 0 .. 1, of the step where it is likeliest
[[nodiscard]] float touch_likelihood(const Trajectory& trajectory, const satp::Mode& mode, const Track& track,
                                     const Parameters& parameters);

/// Expected number of vehicles the trajectory touches within the horizon, over all their futures. A prediction without our
/// plan knows whoever follows us as it drives if we go on: that touch is counted on our plan only.
/// \param work  what it takes is charged; it ends in any case
[[nodiscard]] float expected_collisions(const scene::Scene& scene, const satp::PredictionSet& prediction,
                                        const Trajectory& trajectory, const Parameters& parameters,
                                        WorkMeter& work);

}  // namespace s4tp::sadrf
