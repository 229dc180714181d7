#include "hal/mps/interrupts.hpp"

#include "hal/mps/board.hpp"

namespace s4tp::hal::mps {
namespace {

constexpr std::uintptr_t kSetEnable = 0xE000E100;  // one bit an interrupt
constexpr std::uintptr_t kSetPending = 0xE000E200;
constexpr std::uintptr_t kInterruptControl = 0xE000ED04;
constexpr std::uint32_t kPendSvSet = 1U << 28;
constexpr std::uint32_t kPendSvClear = 1U << 27;
constexpr std::uintptr_t kPriorityOfPendSv = 0xE000ED22;
// Devices and SysTick keep priority 0, the highest, from reset.
constexpr std::uint8_t kLowest = 0xFF;

void set_bit(std::uintptr_t registers, int number) {
  reg(registers + static_cast<std::uintptr_t>(number / 32) * 4U) = 1U << (number % 32);
}

}  // namespace

void start_control_interrupt() {
  *reinterpret_cast<volatile std::uint8_t*>(kPriorityOfPendSv) = kLowest;
}

void pend_control_interrupt() {
  reg(kInterruptControl) = kPendSvSet;
}

void forget_control_interrupt() {
  reg(kInterruptControl) = kPendSvClear;
}

void start_interrupt(int number) {
  set_bit(kSetEnable, number);
}

void pend_interrupt(int number) {
  set_bit(kSetPending, number);
}

}  // namespace s4tp::hal::mps
