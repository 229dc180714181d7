#pragma once
/// The ECU's faults in words.

#include <string>

#include "firmware/ecu/modes.hpp"

namespace s4tp::campaign {

/// Of each bit its name, joined with commas; empty when there is none.
[[nodiscard]] std::string fault_names(ecu::Faults faults);

}  // namespace s4tp::campaign
