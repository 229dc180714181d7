#pragma once
/// Junctions as SUMO describes them, kept only while a network is being read: the ways through and who
/// yields.

#include <cstddef>
#include <vector>

#include "sim_host/world/network.hpp"

namespace s4tp::world {

/// One way through a junction.
struct Link {
  LaneId from = kNoLane;
  std::vector<LaneId> inside;  ///< two or more where SUMO lets a car wait inside the junction
  LaneId to = kNoLane;
  std::vector<bool> yields_to;  ///< by index of the other link; empty: the network does not say
  std::vector<bool> foes;       ///< the same, of those that SUMO holds to share ground
};

struct Junction {
  std::vector<Link> links;
};

/// Finds by geometry where cars on different ways through a junction would touch.
[[nodiscard]] std::vector<NetworkConflict> find_conflicts(const std::vector<NetworkLane>& lanes,
                                                          const std::vector<Junction>& junctions);

}  // namespace s4tp::world
