#pragma once
/// A lane of a network by its id.

#include <cstddef>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {

/// \pre id is one of the network's
[[nodiscard]] inline const Lane& lane_of(const Network& network, LaneId id) {
  return network.lanes[static_cast<std::size_t>(id)];
}

}  // namespace s4tp::map
