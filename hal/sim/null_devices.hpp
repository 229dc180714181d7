#pragma once
/// Devices a simulation needs in name only.

#include <cstdint>

#include "hal/cycle_counter.hpp"
#include "hal/watchdog.hpp"

namespace s4tp::hal::sim {

/// HAL-012 Counts its kicks, so that a test sees whether the ECU is alive.
class NullWatchdog final : public Watchdog {
 public:
  void kick() override { ++kicks_; }
  [[nodiscard]] std::uint32_t kicks() const { return kicks_; }

 private:
  std::uint32_t kicks_ = 0;
};

/// HAL-013 Always 0: a host's cycles differ from run to run and would make two logs of one drive differ.
class NullCycleCounter final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t now() const override { return 0; }
};

}  // namespace s4tp::hal::sim
