#pragma once
/// CMSDK APB watchdog: interrupt at the first expiry, reset at the second. Source: Arm DDI 0479.

#include <cstdint>

#include "hal/watchdog.hpp"

namespace s4tp::hal::mps {

class CmsdkWatchdog final : public Watchdog {
 public:
  /// MPS-030 Without a kick for `timeout_ms` the processor is reset (after a second time-out of that length).
  void start(std::uint32_t timeout_ms);
  void kick() override;
};

}  // namespace s4tp::hal::mps
