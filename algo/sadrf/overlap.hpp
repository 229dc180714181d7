#pragma once
/// Predicted overlap of boxes: the crash term of a score, apart from the field (method.md 3: a vehicle
/// that stands across a lane has no ego-side risk).

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::sadrf {

/// First step whose boxes are nearer than `margin_m`, or -1. A vehicle nearer than that from the first step
/// on counts when the gap has halved, or, touching already, when it is 0.3 m deeper: standing close is not a
/// collision.
[[nodiscard]] int first_collision(const Trajectory& trajectory, const satp::Mode& mode, const Track& track,
                                  int steps, float margin_m, const Parameters& parameters);

/// Expected number of vehicles the trajectory touches within the horizon, over all their futures.
/// \param work  what it takes is charged; it ends in any case
[[nodiscard]] float expected_collisions(const scene::Scene& scene, const satp::PredictionSet& prediction,
                                        const Trajectory& trajectory, const Parameters& parameters,
                                        WorkMeter& work);

}  // namespace s4tp::sadrf
