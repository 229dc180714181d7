#pragma once
/// A CAN bus. Platforms implement it; nothing here allocates or throws.

#include <cstdint>

namespace s4tp::hal {

/// Classic or FD frame; `length` is the payload in bytes (FD: 8 12 16 20 24 32 48 64 above 8).
struct CanFrame {
  std::uint32_t id = 0;
  std::uint8_t length = 0;
  std::uint8_t data[64] = {};
};

enum class CanState : std::uint8_t { kActive, kPassive, kBusOff, kDown };

/// What became of the frames so far.
struct CanCounters {
  std::uint32_t sent = 0;
  std::uint32_t received = 0;
  std::uint32_t dropped = 0;  ///< queue full, either way
  std::uint32_t errors = 0;
};

class Can {
 public:
  /// Oldest frame received and not yet taken. Never blocks. \return false when there is none
  [[nodiscard]] virtual bool receive(CanFrame& frame) = 0;
  /// Queues a frame. Never blocks. \return false when the queue is full: the frame is counted as dropped
  [[nodiscard]] virtual bool send(const CanFrame& frame) = 0;
  [[nodiscard]] virtual CanState state() const = 0;
  [[nodiscard]] virtual CanCounters counters() const = 0;

 protected:
  ~Can() = default;
};

}  // namespace s4tp::hal
