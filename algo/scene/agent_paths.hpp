#pragma once
/// The paths another vehicle may take, and how likely each is, from where it is and how it moves.

#include "algo/scene/lane_table.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp::scene {

/// Fills paths, probabilities and Frenet coordinates of `agent` from its track; without a lane there are
/// none. A lane change under way is one of them, inside a junction as well, where lanes have no neighbours.
/// `agent.lane` is the hint on entry and the lane found on return.
/// \param hindered  another vehicle ahead gives it a reason to be slow
void build_agent_paths(const LaneTable& table, bool hindered, Agent& agent);

/// Moves the agent along its likeliest path by `seconds`; off the map on the arc it drives.
void bring_forward(const LaneMap* map, float seconds, Agent& agent);

/// Arc length of an agent's centre along somebody's path. \return false when its lane is not one of the
/// path's
[[nodiscard]] bool arc_length_on(const LanePath& path, const Agent& agent, float& s_m);

}  // namespace s4tp::scene
