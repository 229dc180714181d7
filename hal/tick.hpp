#pragma once
/// Where the 100 Hz control tick comes from.
///   timer     a real target: periodic, phase-locked to the motion frame by at most 0.5 ms a tick
///   lockstep  simulation: one tick per TICK frame of the world

#include <cstdint>

namespace s4tp::hal {

class Tick {
 public:
  /// Whether a tick is due; asking takes it.
  [[nodiscard]] virtual bool take() = 0;
  /// Shifts the following ticks by `phase_us` (clamped to +-500). No effect in lock-step.
  virtual void adjust(std::int32_t phase_us) = 0;

 protected:
  ~Tick() = default;
};

}  // namespace s4tp::hal
