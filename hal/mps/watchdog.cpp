#include "hal/mps/watchdog.hpp"

#include "hal/mps/board.hpp"

namespace s4tp::hal::mps {
namespace {

constexpr std::uintptr_t kLoad = kWatchdog + 0x00;
constexpr std::uintptr_t kControl = kWatchdog + 0x08;
constexpr std::uintptr_t kClear = kWatchdog + 0x0C;
constexpr std::uintptr_t kLock = kWatchdog + 0xC00;
constexpr std::uint32_t kUnlock = 0x1ACCE551;
constexpr std::uint32_t kInterruptAndReset = 0x3;

}  // namespace

void CmsdkWatchdog::start(std::uint32_t timeout_ms) {
  reg(kLock) = kUnlock;
  reg(kLoad) = kWatchdogClockHz / 1000 * timeout_ms;
  reg(kControl) = kInterruptAndReset;
}

void CmsdkWatchdog::kick() {
  reg(kClear) = 1;
}

}  // namespace s4tp::hal::mps
