#pragma once
/// A <lane> of SUMO's network format, and who may use it.
/// \throws std::runtime_error "WHERE: what was expected", all of them; the file's name is the caller's to say

#include <optional>
#include <pugixml.hpp>
#include <string>

#include "sim_host/world/map/network.hpp"

namespace s4tp::map {

[[noreturn]] void fail_at(const std::string& where, const std::string& what);
[[nodiscard]] double lane_number(const pugi::xml_node& node, const char* name, double missing,
                                 const std::string& where);
/// Of a lane or a connection. As SUMO has it, an empty list of classes is as good as none.
[[nodiscard]] bool open_to_cars(const pugi::xml_node& node);
/// \param side  "changeLeft", "changeRight"
[[nodiscard]] bool change_open(const pugi::xml_node& lane, const char* side);
/// Everything but its index and its neighbours. \return nothing where a junction's lane is but a point
[[nodiscard]] std::optional<Lane> read_lane(const pugi::xml_node& node, const std::string& edge,
                                            bool in_junction, const std::string& where);

}  // namespace s4tp::map
