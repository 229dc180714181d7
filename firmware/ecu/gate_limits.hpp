#pragma once
/// What the gate may let through, from what the vehicle is.

#include "algo/core/parameters.hpp"
#include "firmware/gate/command_gate.hpp"

namespace s4tp::ecu {

/// ECU-094 The vehicle's own limits, with a margin over what plans ask for where tracking them may need more;
/// what no parameter says stays as the gate has it.
[[nodiscard]] gate::Limits gate_limits(const Parameters& parameters);

}  // namespace s4tp::ecu
