#pragma once
/// Terminal condition (METHOD 4.2): the end of a plan must be safe for ever, though the horizon is 3 s.

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/safety/lane_change.hpp"
#include "algo/safety/right_of_way.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

enum class TerminalCause : std::uint8_t {
  kNone = 0,     ///< the end is safe
  kNoPath,       ///< nothing is known of the way
  kRoadEnd,      ///< cannot stop before the road ends
  kLaneEnd,      ///< cannot stop before the last place to change lanes
  kStopsInZone,  ///< would stand where ways cross
  kZone,         ///< somebody may be in a conflict zone with us
  kLeader,
  kFollower,
};

struct TerminalVerdict {
  TerminalCause cause = TerminalCause::kNone;
  std::uint8_t agent = 255;   ///< who is in the way; 255: nobody
  float arrives_s = 0.0F;     ///< kZone: how soon it can be there; 0: is there; 1e3: not by accelerating
  float needed_s = 0.0F;      ///< kZone: to have left the zone, with the margin due
  std::uint16_t trusted = 0;  ///< bit i: agent i is counted on to leave us a zone (Passage::kTrusted)
  [[nodiscard]] bool safe() const { return cause == TerminalCause::kNone; }
};

/// What is the same for every trajectory from one start along one path.
struct PathSight {
  float start_s_m = 0.0F;  ///< of our rear axle along the path
  bool changes = false;    ///< the path leads into a lane beside,
  bool under_way = false;  ///< and the change is under way
  Neighbours neighbours;   ///< without a change: the leader alone
};

/// \param path  as in judge_terminal
[[nodiscard]] PathSight look_along(const Scene& scene, int path, const TrajectoryPoint& start,
                                   const Parameters& parameters);

/// Safe for ever means, for each conflict zone of the path not yet left at the start:
/// - the end can still stop before it (TERM-001), at comfortable deceleration or as hard as the start already
///   demands: at the stop line, or, for who has waited there long, before the ground shared (TERM-014); or
/// - every vehicle that may reach it leaves it to us (TERM-002): where we yield, it comes
///   safety.zone_margin_s after we have left, at limit * safety.over_limit and accelerating (TERM-003); where
///   it owes us the way, it can stop with 4 m/s^2 or less, or comes later (TERM-004); or it has plainly gone
///   before we come (TERM-005). First come: the other has right of way when it can be there first. Who could
///   stop only with more than 5 m/s^2 is bound to go, and counts on others' present speeds; what waiting and
///   a crossing under way change stands at judge_passage(). Before a crossing is begun, who stands and is
///   trusted must also leave room for our box, all the way through (TERM-023);
/// - the end does not stand in it (TERM-006). Who is inside already has to leave, unless a leader blocks the
///   way (TERM-007).
/// Also: the end can stop before the road ends, unless the goal comes first (TERM-008), with room for the
/// lane changes still due while that can be had comfortably (TERM-012); and behind the leader in the lane of
/// the path, which keeps its speed, or a braking of 0.5 m/s^2 or more, for the horizon and then brakes with
/// rss b_max (TERM-009); it drives until our plan starts, too (TERM-031). A
/// lane change keeps a distance to the leader there that asks for less than rss b_min at once, and leaves the
/// one behind 0.2 s and 1 m, and a braking of 3 m/s^2 at most, 0.5 s later (TERM-010); drive beyond comfort
/// is not counted on for it; and it is not begun beside one who comes into the same lane from its other side.
/// Once begun (lane_change.hpp) the leader counts as any other (TERM-030); once under way the one behind
/// needs room only to stay there, and no room is kept for the next change (TERM-020).
/// \param path  index of the ego path the trajectory follows \param sight  along it, from the trajectory's
/// start
[[nodiscard]] TerminalVerdict judge_terminal(const Scene& scene, int path, const PathSight& sight,
                                             const Trajectory& trajectory, const Parameters& parameters);
/// The same for one trajectory alone.
[[nodiscard]] TerminalVerdict judge_terminal(const Scene& scene, int path, const Trajectory& trajectory,
                                             const Parameters& parameters);

}  // namespace s4tp
