#pragma once
/// Junctions as SUMO describes them, kept only while a network is being read: the ways through and who
/// yields.

#include <cstddef>
#include <optional>
#include <vector>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {

/// One way through a junction.
struct Link {
  LaneId from = kNoLane;
  std::vector<LaneId> inside;  ///< two or more where SUMO lets a car wait inside the junction
  LaneId to = kNoLane;
  std::vector<bool> yields_to;  ///< by index of the other link; empty: the network does not say
  int priority = 0;             ///< of the edge it comes from
};

struct Junction {
  std::vector<Link> links;
  bool signals = false;     ///< both ways of two may be told to wait: then the more important edge goes
  bool first_come = false;  ///< an all-way stop: whoever comes first, whatever the requests say
};

/// Finds by geometry where cars on different ways through a junction would touch.
[[nodiscard]] std::vector<Conflict> find_conflicts(const std::vector<Lane>& lanes,
                                                   const std::vector<Junction>& junctions);

/// A lane through a junction that has none: an arc from the end of one lane to the start of another, as fast
/// as SUMO lets cars turn. \return nothing where the two touch
[[nodiscard]] std::optional<Lane> bridge_between(const Lane& from, const Lane& to);

/// netconvert draws turns with few corners and tighter in the middle than a car can turn. One with corners is
/// put on the arc between its lanes where that stays within 2 m of it.
void round_turn(Lane& turn, const Lane& from, const Lane& to);

}  // namespace s4tp::map
