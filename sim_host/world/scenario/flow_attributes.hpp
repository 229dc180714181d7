#pragma once
/// When, how often and where on its edge the cars of a <flow>, <trip> or <vehicle> enter.
/// \throws std::runtime_error "ELEMENT: what was expected", all of them

#include <pugixml.hpp>
#include <string>

#include "sim_host/world/scenario/traffic_demand.hpp"

namespace s4tp::scenario {

[[noreturn]] void fail_at(const pugi::xml_node& node, const std::string& what);
/// "NAME="VALUE"", as errors name an attribute.
[[nodiscard]] std::string quoted(const pugi::xml_node& node, const char* name);
/// Seconds, or SUMO's [days:]hours:minutes:seconds.
[[nodiscard]] double time_of(const pugi::xml_node& node, const char* name, double missing_s);
/// \param interval  gives begin and end to the flows in it; may be empty
void read_spacing(const pugi::xml_node& node, const pugi::xml_node& interval, DemandFlow& flow);
void read_depart(const pugi::xml_node& node, DepartWish& wish);

}  // namespace s4tp::scenario
