#pragma once
/// Who interrupts whom.
///
/// \code
///   devices and SysTick   short: a byte, a period; never one another
///   PendSV                the control context
///   thread                the planning context
/// \endcode
/// Source: Arm DDI 0403 and DDI 0553 (Armv7-M and Armv8-M), NVIC and system control block.

namespace s4tp::hal::mps {

/// Puts PendSV below all other interrupts. Before the timer starts.
void start_control_interrupt();
/// Runs pendsv_handler() as soon as nothing above it runs.
void pend_control_interrupt();
/// Takes that back.
void forget_control_interrupt();
/// Lets a device's interrupt through, at the devices' priority.
void start_interrupt(int number);
/// As if the device had raised it.
void pend_interrupt(int number);
/// Sleeps until an interrupt comes, also one that is too low to run now.
inline void wait_for_interrupt() {
  __asm__ volatile("wfi" ::: "memory");
}

}  // namespace s4tp::hal::mps
