#pragma once
/// The way of a mission over the network.

#include <string>
#include <vector>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {

/// Shortest drivable way between two places, lane changes included: each counts as 20 m, so that a way that
/// needs none wins over one that is a little shorter.
/// SCN-002 \return its edges, the first one's first; no edge twice
/// \throws std::runtime_error when there is no such way
[[nodiscard]] std::vector<std::string> find_route(const Network& network, LaneId from, double from_s_m,
                                                  LaneId to, double to_s_m);

/// The same from anywhere on one edge to anywhere on another.
[[nodiscard]] std::vector<std::string> find_route(const Network& network, const std::string& from_edge,
                                                  const std::string& to_edge);

}  // namespace s4tp::map
