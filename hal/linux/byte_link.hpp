#pragma once
/// A line that carries bytes both ways: a TCP connection, a pseudo terminal, a serial port. Never blocks.

#include <sys/socket.h>

#include <cstdint>

#include "hal/linux/bus_name.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

class ByteLink {
 public:
  ByteLink();
  ~ByteLink();
  ByteLink(const ByteLink&) = delete;
  ByteLink& operator=(const ByteLink&) = delete;

  /// Looks up the host, opens the device and sets its line: raw, 8 bits, no parity, no flow control.
  /// LINUX-040 A pty must be one, a tty must take the rate asked for. A TCP peer need not be there yet.
  [[nodiscard]] bool open(const BusName& name, Reason& reason);

  [[nodiscard]] bool connected() const { return link_ >= 0; }
  /// LINUX-041 Tries again to get a peer that is not there: connects, accepts, or opens. \return connected()
  bool connect();
  /// \return bytes read; 0: none now, or the link is lost: see connected()
  [[nodiscard]] int read(char* bytes, int size);
  /// \return bytes taken, perhaps fewer; 0: none now, or the link is lost
  [[nodiscard]] int write(const char* bytes, int size);
  /// \return whether something can be read or a peer is there
  [[nodiscard]] bool wait(int timeout_ms);

 private:
  [[nodiscard]] bool resolve(Reason& reason);
  [[nodiscard]] bool listen(Reason& reason);
  [[nodiscard]] int open_device(Reason& reason);
  void watch(int descriptor);
  void lose();
  [[nodiscard]] int failed(int error);

  BusName name_;
  sockaddr_storage address_{};
  socklen_t address_size_ = 0;
  int epoll_ = -1;
  int listener_ = -1;
  int pending_ = -1;  ///< a connection that is being made
  int link_ = -1;
};

}  // namespace s4tp::hal::linux_host
