#include "hal/mps/uart.hpp"

#include "hal/mps/board.hpp"

namespace s4tp::hal::mps {
namespace {

constexpr std::uintptr_t kData = kUart0 + 0x00;
constexpr std::uintptr_t kState = kUart0 + 0x04;
constexpr std::uintptr_t kControl = kUart0 + 0x08;
constexpr std::uintptr_t kBaudDivider = kUart0 + 0x10;
constexpr std::uint32_t kTransmitFull = 1U << 0;
constexpr std::uint32_t kReceiveFull = 1U << 1;
constexpr std::uint32_t kTransmitAndReceive = 0x3;

}  // namespace

void Uart::start(std::uint32_t baud) {
  reg(kBaudDivider) = kCoreClockHz / baud;
  reg(kControl) = kTransmitAndReceive;
}

bool Uart::send(std::uint8_t byte) {
  if ((reg(kState) & kTransmitFull) != 0) return false;
  reg(kData) = byte;
  return true;
}

bool Uart::receive(std::uint8_t& byte) {
  if ((reg(kState) & kReceiveFull) == 0) return false;
  byte = static_cast<std::uint8_t>(reg(kData));
  return true;
}

void Uart::print(const char* text) {
  for (; *text != '\0'; ++text) {
    while (!send(static_cast<std::uint8_t>(*text))) {
    }
  }
}

}  // namespace s4tp::hal::mps
