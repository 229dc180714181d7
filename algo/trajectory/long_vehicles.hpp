#pragma once
/// What lorries and buses take of our way in bends, beyond what cars do.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

/// CAND-026 The map's zones are for usual cars. Both ends of a vehicle follow its lane, and what lies between cuts the bend: for
/// each vehicle longer than kLongM that may come into a zone where we give way, by bend, our ground in that zone is made as long
/// as our box can touch its.
///
/// \code
///     |   |  its lane          our way: -----[ zone ]----->   usual car
///     \    '--------                    --[    zone   ]--->   vehicle of 12 m
/// ----->\___________
/// \endcode
///
/// Where we are already it is not shown: that cannot be helped by waiting. At most kMostSwept pairs of vehicle and zone a path.
/// \pre path.driven is there \return what it took [WorkMeter's units]
int widen_zones(const scene::Scene& scene, const Parameters& parameters, scene::EgoPath& path);

inline constexpr float kLongM = 6.5F;
inline constexpr int kMostSwept = 6;

}  // namespace s4tp::trajectory
