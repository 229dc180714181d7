#pragma once
/// What SocketCan needs of the operating system, so that its behaviour can be tested without CAN.

#include <cstdint>

#include "hal/can.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::hal::linux_host {

enum class ReadResult : std::uint8_t {
  kFrame,    ///< a data frame
  kReport,   ///< an error frame of the controller
  kForeign,  ///< something read that is neither
  kNothing,
  kFailed,  ///< the link needs a look
};

enum class WriteResult : std::uint8_t {
  kSent,
  kFull,     ///< EAGAIN, ENOBUFS: not now
  kRefused,  ///< never: this frame cannot go this way
  kFailed,   ///< the link needs a look
};

enum class LinkState : std::uint8_t { kUp, kDown, kGone, kRenamed };

/// What the controller reported in an error frame.
struct ControllerReport {
  bool bus_off = false;
  bool passive = false;
  bool active = false;    ///< error-active again
  bool overflow = false;  ///< the controller lost frames
};

/// Outcome of one read.
struct Reading {
  CanFrame frame;
  ControllerReport report;
  bool local = false;         ///< written by a program of this machine, not by another node
  std::uint32_t lost = 0;     ///< frames the socket had to drop since the last one read
  std::uint64_t time_us = 0;  ///< of arrival, since 1970
};

class FrameSocket {
 public:
  /// Opens by name, or opens again. \return false with the reason
  [[nodiscard]] virtual bool open(Reason& reason) = 0;
  virtual void close() = 0;
  [[nodiscard]] virtual ReadResult read(Reading& reading) = 0;
  [[nodiscard]] virtual WriteResult write(const CanFrame& frame) = 0;
  /// \return whether something can be read
  [[nodiscard]] virtual bool wait(int timeout_ms) = 0;
  [[nodiscard]] virtual LinkState look() = 0;
  /// Tells the controller to leave bus-off. \return false when that is not possible
  [[nodiscard]] virtual bool restart() = 0;
  [[nodiscard]] virtual std::uint64_t now_ms() const = 0;

 protected:
  ~FrameSocket() = default;
};

}  // namespace s4tp::hal::linux_host
