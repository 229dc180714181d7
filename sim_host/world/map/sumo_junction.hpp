#pragma once
/// The <junction>s of SUMO's network format: the ways through them, as lanes, and who yields.
/// \throws std::runtime_error "WHERE: what was expected", all of them; the file's name is the caller's to say

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "sim_host/world/map/junction_links.hpp"

namespace s4tp::map {

/// What junctions name: lanes and edges.
struct NetworkNames {
  std::map<std::string, LaneId> lane_of;
  std::map<std::string, int> priority;                      ///< of an edge; SUMO's -1: not said
  std::map<std::string, std::vector<std::string>> bridges;  ///< lanes put into a junction that has none
};

/// \param lanes  linked with each other
[[nodiscard]] std::vector<Junction> read_junctions(const pugi::xml_node& net, const std::vector<Lane>& lanes,
                                                   const NetworkNames& names);

/// \throws when a way through a junction is longer than 1000 m (NET-004)
void check_through(const Lane& inside, double length_m);

}  // namespace s4tp::map
