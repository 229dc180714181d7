#pragma once
/// What both processes do with their end of a bus: open it for the other side's messages, and tell its news.

#include <ostream>
#include <string>
#include <vector>

#include "hal/linux/named_bus.hpp"

namespace s4tp::processes {

enum class Side { kEcu, kWorld };

/// Ids of the messages a side sends, from the DBC.
[[nodiscard]] std::vector<std::uint32_t> ids_sent_by(Side side);

/// Opens a bus for `side`: of a network interface it takes the other side's messages only.
/// \throws std::runtime_error with the reason
void open_bus(hal::linux_host::NamedBus& bus, const std::string& name, Side side);

/// PROC-003 Every change of the link is told, with the bus's name.
void print_news(std::ostream& out, const std::string& name, hal::linux_host::LinuxCan& can);

/// Frames sent, received, lost, errors.
void print_counters(std::ostream& out, const std::string& name, const hal::CanCounters& counters);

}  // namespace s4tp::processes
