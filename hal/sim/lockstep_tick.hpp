#pragma once
/// The control tick of a simulation: opens on each TICK frame of the world.

#include <cstdint>

#include "hal/sim/bus.hpp"
#include "hal/tick.hpp"

namespace s4tp::hal::sim {

/// To be set as the listener of the ECU's port.
class LockstepTick final : public Tick, public FrameListener {
 public:
  /// \param tick_id  CAN id of the TICK frame
  explicit LockstepTick(std::uint32_t tick_id) : tick_id_(tick_id) {}

  /// HAL-010 One tick for each TICK frame that reached the port.
  [[nodiscard]] bool take() override {
    if (open_ == 0) return false;
    --open_;
    return true;
  }
  void adjust(std::int32_t /*phase_us*/) override {}
  void frame_arrived(const CanFrame& frame) override {
    if (frame.id == tick_id_) ++open_;
  }

 private:
  std::uint32_t tick_id_;
  std::uint32_t open_ = 0;
};

}  // namespace s4tp::hal::sim
