#include "hal/linux/named_bus.hpp"

#include <stdio.h>

namespace s4tp::hal::linux_host {

bool NamedBus::open(const char* name, const CanSocketOptions& options, Reason& reason) {
  BusName bus;
  if (!parse_bus_name(name, bus, reason)) return false;
  if (bus.kind != BusKind::kInterface) {
    can_ = &slcan_;
    slcan_.filter(options.ids, options.id_count);
    return link_.open(bus, reason);
  }
  can_ = &socket_can_;
  socket_.configure(bus.place, options);
  if (!socket_can_.open(reason)) return false;
  if (socket_.look() == LinkState::kUp) return true;
  snprintf(reason.text, sizeof reason.text, "%s: the interface is down: ip link set %s up", bus.place,
           bus.place);
  return false;
}

}  // namespace s4tp::hal::linux_host
