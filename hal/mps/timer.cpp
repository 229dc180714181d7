#include "hal/mps/timer.hpp"

#include "hal/mps/board.hpp"
#include "hal/phase_lock.hpp"

namespace s4tp::hal::mps {
namespace {

constexpr std::uintptr_t kControl = 0xE000E010;  // SysTick, Armv7-M and Armv8-M
constexpr std::uintptr_t kReload = 0xE000E014;
constexpr std::uintptr_t kCurrent = 0xE000E018;
constexpr std::uintptr_t kInterruptControl = 0xE000ED04;
constexpr std::uint32_t kSysTickPending = 1U << 26;
constexpr std::uint32_t kEnableCoreClockInterrupt = 0x7;

constexpr std::int32_t kCyclesPerUs = kCoreClockHz / 1'000'000;

}  // namespace

void Timer::start(std::uint32_t tick_us) {
  tick_cycles_ = tick_us * static_cast<std::uint32_t>(kCyclesPerUs);
  period_cycles_ = tick_cycles_;
  reg(kReload) = tick_cycles_ - 1;
  reg(kCurrent) = 0;
  reg(kControl) = kEnableCoreClockInterrupt;
}

void Timer::on_interrupt() {
  elapsed_cycles_ = elapsed_cycles_ + period_cycles_;
  due_phase_cycles_ = (due_phase_cycles_ + period_cycles_) % tick_cycles_;
  // The hardware took the reload value when the counter passed zero, so a new one acts a period later.
  period_cycles_ = reg(kReload) + 1;
  reg(kReload) = tick_cycles_ - 1 + static_cast<std::uint32_t>(phase_us_ * kCyclesPerUs);
  phase_us_ = 0;
  due_ = true;
}

bool Timer::take() {
  const bool due = due_;
  due_ = false;
  return due;
}

void Timer::adjust(std::int32_t phase_us) {
  phase_us_ = limited_phase_us(phase_us);
}

std::uint32_t Timer::due_phase_us() const {
  return due_phase_cycles_ / static_cast<std::uint32_t>(kCyclesPerUs);
}

std::uint64_t Timer::cycles() const {
  // Interrupts are off, so a period that ended meanwhile shows as pending.
  std::uint32_t mask = 0;
  __asm__ volatile("mrs %0, primask\n cpsid i" : "=r"(mask)::"memory");
  std::uint32_t into_period = period_cycles_ - 1 - reg(kCurrent);
  std::uint64_t elapsed = elapsed_cycles_;
  if ((reg(kInterruptControl) & kSysTickPending) != 0) {
    elapsed += period_cycles_;
    into_period = reg(kReload) - reg(kCurrent);
  }
  __asm__ volatile("msr primask, %0" ::"r"(mask) : "memory");
  return elapsed + into_period;
}

std::uint64_t Timer::now_us() const {
  return cycles() / static_cast<std::uint32_t>(kCyclesPerUs);
}

std::uint32_t Timer::now() const {
  return static_cast<std::uint32_t>(cycles());
}

}  // namespace s4tp::hal::mps
