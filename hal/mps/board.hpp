#pragma once
/// The two boards as QEMU and the FPGA images have them. Sources: Arm AN500 (mps2) and AN547 (mps3), memory
/// maps.

#include <cstdint>

namespace s4tp::hal::mps {

#if defined(S4TP_BOARD_MPS3_AN547)
inline constexpr std::uint32_t kCoreClockHz = 32'000'000;
inline constexpr std::uintptr_t kUart0 = 0x59303000;  ///< secure alias: the core starts in secure state
inline constexpr std::uintptr_t kUart1 = 0x59304000;
inline constexpr int kUart1Interrupts[2] = {35, 36};     ///< receive and transmit, in the board's order
inline constexpr std::uintptr_t kWatchdog = 0x5802E000;  ///< runs from the 32 kHz clock
inline constexpr std::uint32_t kWatchdogClockHz = 32'768;
#else
inline constexpr std::uint32_t kCoreClockHz = 25'000'000;
inline constexpr std::uintptr_t kUart0 = 0x40004000;
inline constexpr std::uintptr_t kUart1 = 0x40005000;
inline constexpr int kUart1Interrupts[2] = {2, 3};
inline constexpr std::uintptr_t kWatchdog = 0x40008000;
inline constexpr std::uint32_t kWatchdogClockHz = 25'000'000;
#endif

/// A memory-mapped register.
inline volatile std::uint32_t& reg(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace s4tp::hal::mps
