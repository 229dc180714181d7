#pragma once
/// Changing lanes among others: when a change is under way, and what it may ask of who is behind.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"

namespace s4tp {

/// A lane change may ask this much braking of the vehicle behind in the lane we come to.
inline constexpr float kFollowerBrakingMps2 = 3.0F;

/// Whether a corner of ours at `start` is over the line of the path's lane, or will be within half a second,
/// even if we brake comfortably: what is given up then ends astride two lanes.
[[nodiscard]] bool change_under_way(const Scene& scene, const EgoPath& path, const TrajectoryPoint& start,
                                    const Parameters& parameters);

/// Whether the vehicle is coming into a lane of the path from the lane beside it.
[[nodiscard]] bool joins(const Scene& scene, const EgoPath& path, const Agent& agent);

/// Who will be ahead of and behind us in the lane of the path, those who join it counted.
struct Neighbours {
  Leader leader;
  Leader follower;
  int joins_beside = -1;  ///< who joins it neither ahead nor behind; -1: nobody
};
[[nodiscard]] Neighbours find_neighbours(const Scene& scene, const EgoPath& path,
                                         const Parameters& parameters);

}  // namespace s4tp
