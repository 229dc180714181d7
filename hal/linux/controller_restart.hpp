#pragma once
/// The one request to a CAN network interface that is not made through its socket.

namespace s4tp::hal::linux_host {

/// Tells the controller of an interface to leave bus-off (rtnetlink; needs CAP_NET_ADMIN).
/// \return false when the kernel refused: no right to, no CAN controller, or not in bus-off
[[nodiscard]] bool restart_controller(int interface_index);

}  // namespace s4tp::hal::linux_host
