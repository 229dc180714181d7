#include "sim_host/processes/bus_end.hpp"

#include <stdexcept>

#include "firmware/wire/codec.hpp"

namespace s4tp::processes {

std::vector<std::uint32_t> ids_sent_by(Side side) {
  std::vector<std::uint32_t> ids;
  for (const wire::MessageInfo& message : wire::kMessages) {
    const bool by_ecu = std::string(message.sender) == "ECU";
    if (by_ecu == (side == Side::kEcu)) ids.push_back(message.id);
  }
  return ids;
}

void open_bus(hal::linux_host::NamedBus& bus, const std::string& name, Side side) {
  const std::vector<std::uint32_t> ids = ids_sent_by(side == Side::kEcu ? Side::kWorld : Side::kEcu);
  hal::linux_host::CanSocketOptions options;
  options.ids = ids.data();
  options.id_count = static_cast<int>(ids.size());
  hal::linux_host::Reason reason;
  if (!bus.open(name.c_str(), options, reason)) throw std::runtime_error(reason.text);
}

void print_news(std::ostream& out, const std::string& name, hal::linux_host::LinuxCan& can) {
  for (hal::linux_host::LinkNews news{}; can.take_news(news);) {
    out << name << ": " << hal::linux_host::link_news_text(news) << std::endl;
  }
}

void print_counters(std::ostream& out, const std::string& name, const hal::CanCounters& counters) {
  out << name << ": " << counters.sent << " frames sent, " << counters.received << " received, "
      << counters.dropped << " lost, " << counters.errors << " errors\n";
}

}  // namespace s4tp::processes
