#pragma once
/// Names of buses, as the user gives them.
///
///   can0, vcan0                   a CAN network interface
///   slcan:tcp:HOST:PORT           SLCAN to whoever listens there (QEMU's serial port, a network adapter)
///   slcan:listen:HOST:PORT        the same, the other end; HOST is an address of this machine
///   slcan:listen:anyone:PORT      on all its addresses, for whoever reaches it
///   slcan:pty:PATH                a pseudo terminal that is there (QEMU's, socat's)
///   slcan:tty:PATH@BAUD           a serial CAN adapter or board

#include <cstdint>

#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

enum class BusKind : std::uint8_t { kInterface, kTcp, kListen, kPty, kTty };

struct BusName {
  BusKind kind = BusKind::kInterface;
  char place[100] = {};    ///< interface, host or path; of kListen "anyone": every address
  std::uint16_t port = 0;  ///< of kTcp and kListen
  std::uint32_t baud = 0;  ///< of kTty
};

/// LINUX-042 Whoever connects to a listener is the bus: a host that means all of this machine's addresses
/// (0.0.0.0, ::) is refused when the line is opened, unless the name says this word.
inline constexpr const char* kAnyone = "anyone";

/// LINUX-030 \return false with a reason that says what is accepted; LINUX-031 a tty slower than 1 Mbaud is
/// refused
[[nodiscard]] bool parse_bus_name(const char* text, BusName& name, Reason& reason);

}  // namespace s4tp::hal::linux_host
