#pragma once
/// Changing lanes among others: when a change is under way, and what it may ask of who is behind.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"

namespace s4tp {

/// A lane change may ask this much braking of the one behind in the lane we come to, this much later.
inline constexpr float kFollowerBrakingMps2 = 3.0F;
inline constexpr float kFollowerReactionS = 0.5F;

/// Whether the path is another lane than the one most of us is in.
[[nodiscard]] bool changes_lane(const Scene& scene, const EgoPath& path);

/// Whether a corner of ours at `start` is over the line of the path's lane, or will be within half a second,
/// even if we brake comfortably: what is given up then ends astride two lanes (TERM-017).
[[nodiscard]] bool change_under_way(const Scene& scene, const EgoPath& path, const TrajectoryPoint& start,
                                    const Parameters& parameters);

/// Notes which path the running plan leads to at its end. A change it leads to is begun: it kept a start's
/// distance to the leader then, who never does exactly as predicted, and from now on follows him as any
/// other; else it would be given up and taken up again (TERM-030). The one behind counts as at the start
/// until it is under way.
void mark_bound_for(const Plan& running, std::uint32_t start_ms, Scene& scene);

/// Whether the vehicle is coming into a lane of the path from the lane beside it (TERM-019).
[[nodiscard]] bool joins(const Scene& scene, const EgoPath& path, const Agent& agent);

/// Who will be ahead of and behind us in the lane of the path, those who join it counted.
struct Neighbours {
  Leader leader;
  Leader follower;
  int joins_beside = -1;  ///< who joins it neither ahead nor behind; -1: nobody
};
[[nodiscard]] Neighbours find_neighbours(const Scene& scene, const EgoPath& path,
                                         const Parameters& parameters);

/// Whether who is `gap_m` behind us at the start, `speed_mps` fast, stays behind us on the whole trajectory
/// and at its end speed for ever, braking with kFollowerBrakingMps2 or less after half a second (TERM-018).
[[nodiscard]] bool can_stay_behind(float gap_m, float speed_mps, const Trajectory& trajectory);

}  // namespace s4tp
