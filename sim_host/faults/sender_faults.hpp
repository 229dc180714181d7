#pragma once
/// Faults of a sending node: what it says is wrong, and sealed.

#include <cstdint>
#include <map>
#include <vector>

#include "firmware/wire/frame.hpp"
#include "sim_host/faults/script.hpp"

namespace s4tp::faults {

/// Random numbers that depend on nothing but where they are drawn.
[[nodiscard]] std::uint64_t draw(const Fault& fault, int tick, std::size_t place);

void shift_clock(const Fault& fault, int tick, wire::Frame& frame);
/// \param held  what the message said when the fault began
void hold(const Fault& fault, std::map<std::uint32_t, wire::Frame>& held, wire::Frame& frame);
void overwrite(const Fault& fault, wire::Frame& frame);
void lengthen(const Fault& fault, int tick, std::vector<wire::Frame>& frames);
void babble(const Fault& fault, int tick, std::vector<wire::Frame>& frames);

}  // namespace s4tp::faults
