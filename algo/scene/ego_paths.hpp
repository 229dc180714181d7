#pragma once
/// The paths we may take, with what crosses them.

#include "algo/core/parameters.hpp"
#include "algo/scene/lane_table.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::scene {

/// Fills scene.ego_paths from the lane under us: keep, then left and right where the map allows a change.
/// Each goes on along the route; where that ends, straight on. A change that has not begun is offered only where half of it
/// is made before a junction begins. \pre table.valid(lane)
void build_ego_paths(const LaneTable& table, LaneIndex lane, const Parameters& parameters, Scene& scene);

inline constexpr float kStopMarginM = 1.0F;  ///< before a zone, where no stop line says otherwise

/// Adds a zone, to one it continues where there is one; with no room left, in place of one that matters less. They stay in
/// order only once sorted.
void add_zone(const ConflictZone& zone, EgoPath& ego_path);
void sort_zones(EgoPath& ego_path);

}  // namespace s4tp::scene
