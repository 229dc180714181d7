#pragma once
/// The road part of R_ego: the field along the candidate's own remaining path, times what the road costs
/// across it. The widening is that of `kolekar2020` driven straight: a field that follows its own path needs
/// no allowance for steering (method.md 3).

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/sadrf/drivable.hpp"

namespace s4tp::sadrf {

/// Road risk at points `first`, `first` + `stride`, ... of the trajectory, written to road[point - 1]; the
/// other elements stay as they are. Beyond its last one the path goes on with its last curvature, for the
/// look-ahead distance there. Without a map: 0. \pre 1 <= first, 1 <= stride
void road_risk(const DrivableArea& area, const Trajectory& trajectory, const Parameters& parameters,
               int first, int stride, float (&road)[kHorizonSteps], WorkMeter& work);
/// What it takes in any case.
inline constexpr std::int32_t kLeastRoadWork = 200;

}  // namespace s4tp::sadrf
