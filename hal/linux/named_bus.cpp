#include "hal/linux/named_bus.hpp"

#include <stdio.h>

namespace s4tp::hal::linux_host {

bool NamedBus::open(const char* text, const CanSocketOptions& options, Reason& reason) {
  BusName name;
  if (!parse_bus_name(text, name, reason)) return false;
  if (name.kind != BusKind::kInterface) {
    can_ = &slcan_;
    return link_.open(name, reason);
  }
  can_ = &socket_can_;
  socket_.configure(name.place, options);
  if (!socket_can_.open(reason)) return false;
  if (socket_.look() == LinkState::kUp) return true;
  snprintf(reason.text, sizeof reason.text, "%s: the interface is down: ip link set %s up", name.place,
           name.place);
  return false;
}

}  // namespace s4tp::hal::linux_host
