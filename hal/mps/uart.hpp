#pragma once
/// CMSDK APB UART 0, polled. Source: Arm DDI 0479 (Cortex-M System Design Kit), section APB UART.

#include <cstdint>

namespace s4tp::hal::mps {

class Uart {
 public:
  void start(std::uint32_t baud);
  /// MPS-020 Never waits. \return false when the transmitter is full
  [[nodiscard]] bool send(std::uint8_t byte);
  /// MPS-021 Never waits. \return false when nothing has arrived
  [[nodiscard]] bool receive(std::uint8_t& byte);
  /// Waits for the transmitter: for the boot line and last words, not for the control context.
  void print(const char* text);
};

}  // namespace s4tp::hal::mps
