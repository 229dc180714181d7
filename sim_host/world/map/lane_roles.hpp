#pragma once
/// What the lanes of a network mean to whoever drives a route: which to drive on, which matter most,
/// and where to be ready to stop.

#include <vector>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {

/// `Ours` is every lane that one can come to from the route by driving forward and changing lanes, without
/// turning round (a missed turn still leads onto lanes of ours), and every lane that leads straight onto the
/// route (the main road beside a ramp). Every other one counts as opposite: it leads against us, or only
/// others can be on it. \return by lane
[[nodiscard]] std::vector<bool> lanes_of_ours(const Network& network, const RouteGuide& guide);

/// 0 on the route, 1 in conflict with it or leading there, 2 neighbours of these, 3 the rest. \return by lane
[[nodiscard]] std::vector<int> lane_ranks(const Network& network, const RouteGuide& guide);

/// Whether the way on from the lane's end gives priority to anybody; on the route only the way it takes
/// counts.
[[nodiscard]] bool yields_at_end(const Network& network, const RouteGuide& guide, LaneId lane);

}  // namespace s4tp::map
