#pragma once
/// What a motion keeps clear of: per step the half-planes that separate our box from the predicted ones
/// nearest to it.

#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/ilqr_problem.hpp"

namespace s4tp::trajectory {

/// Everybody's futures, as the check reads them.
struct Surroundings {
  const scene::Scene& scene;
  const satp::PredictionSet& marginal;
  const satp::PredictionSet& conditioned;
  const satp::KinematicSet& constant_velocity;
};

/// Writes half_planes of every step: of each vehicle the future nearest to our box on `trajectory`, of these
/// the kMaxHalfPlanes nearest, unless it is further than `reach_m`. Futures that overlap our box are left
/// out: who chose the trajectory has forgiven them. \param origin  what the problem's positions are relative
/// to
void find_half_planes(const Surroundings& surroundings, const Trajectory& trajectory, Point origin,
                      float reach_m, const Parameters& parameters, RefinementProblem& problem);

}  // namespace s4tp::trajectory
