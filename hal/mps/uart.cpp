#include "hal/mps/uart.hpp"

namespace s4tp::hal::mps {
namespace {

// Offsets of the registers.
constexpr std::uintptr_t kData = 0x00;
constexpr std::uintptr_t kState = 0x04;
constexpr std::uintptr_t kControl = 0x08;
constexpr std::uintptr_t kInterruptState = 0x0C;
constexpr std::uintptr_t kBaudDivider = 0x10;

constexpr std::uint32_t kTransmitFull = 1U << 0;
constexpr std::uint32_t kReceiveFull = 1U << 1;
constexpr std::uint32_t kReceiveOverrun = 1U << 3;
constexpr std::uint32_t kTransmitAndReceive = 0x3;
constexpr std::uint32_t kTransmitAndReceiveInterrupts = 0xC;
constexpr std::uint32_t kAnyInterrupt = 0x3;

}  // namespace

void Uart::start(std::uint32_t baud) {
  reg(base_ + kBaudDivider) = kCoreClockHz / baud;
  reg(base_ + kControl) = kTransmitAndReceive;
}

void Uart::enable_interrupts() {
  reg(base_ + kControl) = kTransmitAndReceive | kTransmitAndReceiveInterrupts;
}

void Uart::clear_interrupts() {
  reg(base_ + kInterruptState) = kAnyInterrupt;
}

bool Uart::send(std::uint8_t byte) {
  if ((reg(base_ + kState) & kTransmitFull) != 0) return false;
  reg(base_ + kData) = byte;
  return true;
}

bool Uart::receive(std::uint8_t& byte) {
  if ((reg(base_ + kState) & kReceiveFull) == 0) return false;
  byte = static_cast<std::uint8_t>(reg(base_ + kData));
  return true;
}

bool Uart::take_overrun() {
  if ((reg(base_ + kState) & kReceiveOverrun) == 0) return false;
  reg(base_ + kState) = kReceiveOverrun;
  return true;
}

void Uart::print(const char* text) {
  for (; *text != '\0'; ++text) {
    while (!send(static_cast<std::uint8_t>(*text))) {
    }
  }
}

}  // namespace s4tp::hal::mps
