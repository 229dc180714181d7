#pragma once
/// What lorries and buses take of our way in bends, beyond what cars do.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

/// CAND-026 The map's zones are for usual cars. Both ends of a vehicle follow its lane, and what lies between cuts the bend: for
/// each vehicle longer than kLongM that may come into a zone by a bend our ground in that zone is made as long as our box can
/// touch its.
///
/// \code
///     |   |  its lane          our way: -----[ zone ]----->   usual car
///     \    '--------                    --[    zone   ]--->   vehicle of 12 m
/// ----->\___________
/// \endcode
///
/// It begins no sooner than we can stop before it: who is past that is no more bound by it than by the map's, and has no more right to
/// what is beyond. At most kMostSwept pairs of vehicle and zone a path.
/// \param lead_s  from the scene to the start of plans \pre path.driven is there \return what it took [WorkMeter's units]
int widen_zones(const scene::Scene& scene, const Parameters& parameters, float lead_s, scene::EgoPath& path);

inline constexpr float kLongM = 6.5F;
inline constexpr int kMostSwept = 6;

}  // namespace s4tp::trajectory
