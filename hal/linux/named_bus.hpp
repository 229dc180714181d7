#pragma once
/// A bus by its name: the one thing a program needs of this folder.

#include "hal/linux/bus_name.hpp"
#include "hal/linux/byte_link.hpp"
#include "hal/linux/can_socket.hpp"
#include "hal/linux/slcan_can.hpp"
#include "hal/linux/socket_can.hpp"

namespace s4tp::hal::linux_host {

class NamedBus {
 public:
  /// Once. LINUX-032 At the start a bus must be there: an interface that is missing, down or no CAN
  /// interface, a device that cannot be opened, a host that cannot be found are refused with the reason. Only
  /// a TCP peer may come later. \param options  for a network interface; SLCAN takes what the other end sends
  [[nodiscard]] bool open(const char* name, const CanSocketOptions& options, Reason& reason);

  /// \pre open() said true
  [[nodiscard]] LinuxCan& can() { return *can_; }

 private:
  CanSocket socket_;
  SocketCan socket_can_{socket_};
  ByteLink link_;
  SlcanCan slcan_{link_};
  LinuxCan* can_ = nullptr;
};

}  // namespace s4tp::hal::linux_host
