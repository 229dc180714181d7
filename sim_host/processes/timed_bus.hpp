#pragma once
/// The ECU's end of a bus in real time: frames are taken when they come, as a receive interrupt would, and
/// kept for the next tick of the ECU's own timer.

#include <cstdint>
#include <optional>

#include "firmware/lockstep/lockstep_bus.hpp"
#include "hal/can.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::processes {

class TimedBus final : public hal::Can {
 public:
  static constexpr int kQueueFrames = lockstep::LockstepBus::kQueueFrames;

  /// \param can  must outlive this
  explicit TimedBus(hal::linux_host::LinuxCan& can) : can_(can) {}

  /// Takes what has come; waits for the first up to `timeout_ms`. \return frames taken
  int take(int timeout_ms);

  /// PROC-002 As in lock-step: a TICK frame that would open none is not handed on; of more than
  /// kQueueFrames a tick the oldest are dropped and counted.
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return can_.send(frame); }
  [[nodiscard]] hal::CanState state() const override { return can_.state(); }
  [[nodiscard]] hal::CanCounters counters() const override;

  /// When the last valid motion frame came [us, monotonic]; asking takes it.
  [[nodiscard]] std::optional<std::uint64_t> take_motion_arrival();
  /// Whether a valid TICK frame came since it was last asked.
  [[nodiscard]] bool take_heard();
  /// TICK frames not handed on.
  [[nodiscard]] std::uint32_t refused_ticks() const { return refused_ticks_; }

 private:
  void keep(const hal::CanFrame& frame);

  hal::linux_host::LinuxCan& can_;
  lockstep::TickOpener opener_;
  hal::CanFrame queue_[kQueueFrames];
  int first_ = 0;
  int size_ = 0;
  std::uint32_t dropped_ = 0;
  std::optional<std::uint64_t> motion_us_;
  bool heard_ = false;
  std::uint32_t refused_ticks_ = 0;
};

}  // namespace s4tp::processes
