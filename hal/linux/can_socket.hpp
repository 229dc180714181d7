#pragma once
/// A raw CAN socket on a network interface: non-blocking, filtered in the kernel, with times and drop counts.

#include <cstdint>

#include "hal/linux/frame_socket.hpp"

namespace s4tp::hal::linux_host {

struct CanSocketOptions {
  const std::uint32_t* ids = nullptr;  ///< 11-bit ids to receive, at most kIdsMax; copied
  int id_count = 0;                    ///< 0: all
  bool believe_local_reports =
      false;  ///< error frames written by programs of this machine count too: for tests
};

class CanSocket final : public FrameSocket {
 public:
  static constexpr int kIdsMax = 64;
  static constexpr int kNameSize = 16;  ///< IFNAMSIZ

  CanSocket();
  ~CanSocket();
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;

  /// Before open(). \param name  of the interface, shorter than kNameSize
  void configure(const char* name, const CanSocketOptions& options);
  /// Before open(): a descriptor that keeps message borders, to be read and written like a CAN socket.
  void adopt(int descriptor);

  /// LINUX-020 Filters stand before the socket is bound, so nothing else is ever queued: data frames with one
  /// of the ids, 11 bits, and the controller's error frames.
  [[nodiscard]] bool open(Reason& reason) override;
  void close() override;
  /// LINUX-021 Time of arrival and count of frames lost come with the frame, from the kernel.
  [[nodiscard]] ReadResult read(Reading& reading) override;
  /// LINUX-022 More than 8 bytes go as a CAN FD frame, and only where the interface's MTU has room for one.
  [[nodiscard]] WriteResult write(const CanFrame& frame) override;
  [[nodiscard]] bool wait(int timeout_ms) override;
  /// LINUX-023 The interface is known by its name: another index or name is another interface.
  [[nodiscard]] LinkState look() override;
  [[nodiscard]] bool restart() override;
  [[nodiscard]] std::uint64_t now_ms() const override;

 private:
  [[nodiscard]] bool set_up(Reason& reason);

  char name_[kNameSize] = {};
  std::uint32_t ids_[kIdsMax] = {};
  int id_count_ = 0;
  bool believe_local_reports_ = false;
  int epoll_ = -1;
  int socket_ = -1;
  int index_ = 0;           ///< of the interface; 0: adopted
  bool flexible_ = true;    ///< the interface takes CAN FD frames
  std::uint32_t lost_ = 0;  ///< the socket's own count so far
};

}  // namespace s4tp::hal::linux_host
