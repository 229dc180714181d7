#pragma once
/// From the map as the wire carries it to the map the planner reads.

#include "algo/core/world_state.hpp"
#include "firmware/wire/lane_map.hpp"

namespace s4tp::ecu {

/// ECU-060 Lengths are computed; links and conflicts to a lane that is not there are cut; a lane without
/// extent is not present.
void convert(const wire::Map& from, LaneMap& to);

}  // namespace s4tp::ecu
