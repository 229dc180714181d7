#include "sim_host/world/map/network.hpp"

#include <algorithm>

namespace s4tp::map {

LaneId Network::find(const std::string& lane_name) const {
  const auto found =
      std::find_if(lanes.begin(), lanes.end(), [&](const Lane& lane) { return lane.name == lane_name; });
  return found == lanes.end() ? kNoLane : static_cast<LaneId>(found - lanes.begin());
}

LaneId Network::lane_of(const std::string& edge, int index) const {
  const auto found = std::find_if(lanes.begin(), lanes.end(),
                                  [&](const Lane& lane) { return lane.index == index && lane.edge == edge; });
  return found == lanes.end() ? kNoLane : static_cast<LaneId>(found - lanes.begin());
}

std::vector<LaneId> Network::lanes_of(const std::string& edge) const {
  std::vector<LaneId> found;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (lanes[i].edge == edge) {
      found.push_back(static_cast<LaneId>(i));
    }
  }
  std::sort(found.begin(), found.end(), [&](LaneId a, LaneId b) {
    return lanes[static_cast<std::size_t>(a)].index < lanes[static_cast<std::size_t>(b)].index;
  });
  return found;
}

}  // namespace s4tp::map
