#pragma once
/// The minimum-risk manoeuvre: what is driven when nothing else passes. There is always one, and it is a
/// ladder, climbed anew each cycle:
///
/// \code
///   comfortable stop  entered: nothing passes the check, no lane, broken input (planner.hpp)
///                     brakes with safety.minimum_risk_braking; left: a plan passes, or at rest
///   hard stop         entered: that is not enough before a leader, the road's end or a zone
///                     brakes as hard as it takes; left: less will do, or as above
///   clearing          entered: inside a zone, and the way out is free
///                     drives with 2 m/s^2, stops behind the zone; left: clear of it, or not free
///   hold              entered: at rest; the pose stays; left: a plan passes
/// \endcode
/// When the ECU itself loses what planning needs, the last plan's path is driven to a stop and held until the
/// driver lets go (modes.hpp). Shoulders are not used: no map node of ours sends any.

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

/// Brakes to a stop along our lane, or the running plan's path, or the present curvature: the first of them
/// that is known and can be followed (MRM-001). Deceleration safety.minimum_risk_braking; harder, up to
/// vehicle.braking_max, when a leader or the road's end demands it (MRM-002), or up to 6 m/s^2 to stop before
/// a conflict zone instead of in it (MRM-003). An ego already inside a zone leaves it first when its way is
/// free (MRM-004). Every value is finite, speed never grows except to leave a zone, at rest the pose stays
/// (MRM-005). The scene may be empty: no map, no paths (MRM-006). The stop ends in a lane: of those we are in
/// or bound for, the one where who is behind is farther than the safe distance, or nearest to it, and not
/// before we are in it (MRM-007); in one we come into we brake only so hard that who is behind there can stop
/// with kFollowerBrakingMps2, unless what is ahead demands more (MRM-008), and yet hard enough to come to
/// rest: with 1.5 m/s^2 at least for who is behind, 0.5 m/s^2 for the way across.
void minimum_risk(const Scene& scene, const TrajectoryPoint& start, const Plan& running,
                  std::uint32_t start_ms, const Parameters& parameters, Trajectory& trajectory);

}  // namespace s4tp
