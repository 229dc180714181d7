#pragma once
/// The road part of R_ego: the field along the candidate's own remaining path, times what the road costs
/// across it. The widening is that of `kolekar2020` driven straight: a field that follows its own path needs
/// no allowance for steering (METHOD section 3).

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/sadrf/drivable.hpp"

namespace s4tp {

/// Road risk of every `stride`-th step: road[i] for step i + 1, where i + 1 is a multiple of `stride`; the
/// others stay as they are. Beyond the last point the path goes on with its last curvature, for the last
/// point's look-ahead distance. \pre stride divides kHorizonSteps
void road_risk(const DrivableArea& area, const Trajectory& trajectory, const Parameters& parameters,
               int stride, float (&road)[kHorizonSteps]);

}  // namespace s4tp
