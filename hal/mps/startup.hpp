#pragma once
/// From reset to image_main(): vector table, FPU, .data, .bss, constructors; and what the stack has needed
/// since.

#include <cstdint>

extern "C" {
/// Defined by every image: where it starts. Returning is a fault.
void image_main();
/// Defined by an image that wants it; otherwise nothing happens.
void systick_handler();
/// The same; interrupts.hpp.
void pendsv_handler();
/// The same, for the interrupts of UART 1.
void uart1_handler();
/// First expiry of the watchdog; unless defined, waits for the second one, which resets.
void nmi_handler();
/// Any fault of the core. An image without a debugger waits here for its watchdog.
void fault_handler();
}

namespace s4tp::hal::mps {

/// MPS-001 Highest use of the stack since reset [bytes], from the paint left.
[[nodiscard]] std::uint32_t stack_used();
[[nodiscard]] std::uint32_t stack_size();

}  // namespace s4tp::hal::mps
