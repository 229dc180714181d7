#pragma once
/// CMSDK APB UART: one byte of room either way. Source: Arm DDI 0479 (Cortex-M System Design Kit), section
/// APB UART.

#include <cstdint>

#include "hal/mps/board.hpp"

namespace s4tp::hal::mps {

class Uart {
 public:
  /// \param base  kUart0 or kUart1
  explicit Uart(std::uintptr_t base = kUart0) : base_(base) {}

  void start(std::uint32_t baud);
  /// From now on a byte received, and room for one to be sent, raise the UART's interrupts.
  void enable_interrupts();
  /// First thing in the handler, so that what comes after it raises an interrupt again.
  void clear_interrupts();
  /// MPS-020 Never waits. \return false when the transmitter is full
  [[nodiscard]] bool send(std::uint8_t byte);
  /// MPS-021 Never waits. \return false when nothing has arrived
  [[nodiscard]] bool receive(std::uint8_t& byte);
  /// Waits for the transmitter: for the boot line and last words, not for the control context.
  void print(const char* text);
  /// Whether a byte was lost because the one before it had not been taken; asking forgets it.
  [[nodiscard]] bool take_overrun();

 private:
  std::uintptr_t base_;
};

}  // namespace s4tp::hal::mps
