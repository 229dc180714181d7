#pragma once
/// What our way through a bend that is tighter than we can steer takes of the lanes beside it.

#include "algo/core/parameters.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::trajectory {

/// CAND-025 Adds a zone (`beside`) for each lane, outside junctions and none of the path's, into which our box comes as near
/// as kBesideRoomM to a usual car there, where the path's line is tight: the map's zones are for cars in their lanes. Whoever
/// is there does not expect us, so that we wait, where the map's zones have us wait, until it is gone and nobody comes,
/// or LEGAL-006 lets us pass.
/// \pre path.driven is there \return what it took [WorkMeter's units]
int add_zones_beside(const scene::Scene& scene, const Parameters& parameters, scene::EgoPath& path);

inline constexpr float kBesideRoomM = 0.2F;

}  // namespace s4tp::trajectory
