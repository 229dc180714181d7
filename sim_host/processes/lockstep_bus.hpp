#pragma once
/// The ECU's end of a bus in lock-step: what has arrived up to a TICK frame, tick by tick.
///
/// \code
///   bus      M S P T | M S T | M S ..     frames keep coming while the ECU works
///   tick n   M S P T |                    it gets these, and no frame of the next tick
/// \endcode

#include <chrono>
#include <cstdint>

#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::processes {

/// Which TICK frames open a tick.
class TickOpener {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// PROC-001 Opens on a TICK frame whose CRC fits and whose number is 1 .. kAheadMax further than the last
  /// one's: not on a damaged or repeated one. After 1 s of silence any number will do: another world.
  [[nodiscard]] bool opens(const wire::Frame& frame, Time now);

  static constexpr std::uint16_t kAheadMax = 1000;

 private:
  bool seen_ = false;
  std::uint16_t number_ = 0;
  Time opened_{};
};

class LockstepBus final : public hal::Can {
 public:
  static constexpr int kQueueFrames = 512;  ///< as the in-process bus has

  /// \param can  must outlive this
  explicit LockstepBus(hal::linux_host::LinuxCan& can) : can_(can) {}

  /// Takes frames from the bus up to the next TICK frame that opens a tick. \return false: none in
  /// `timeout_ms`
  [[nodiscard]] bool wait_tick(int timeout_ms);

  /// PROC-002 Frames of the ticks opened so far, in order. A TICK frame that opens none is not handed on; of
  /// more than kQueueFrames the newest are dropped and counted, the TICK frame excepted.
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return can_.send(frame); }
  [[nodiscard]] hal::CanState state() const override { return can_.state(); }
  [[nodiscard]] hal::CanCounters counters() const override;

  /// TICK frames that opened nothing.
  [[nodiscard]] std::uint32_t refused_ticks() const { return refused_ticks_; }

 private:
  /// \return whether this frame opened a tick
  [[nodiscard]] bool take(const hal::CanFrame& frame, TickOpener::Time now);

  hal::linux_host::LinuxCan& can_;
  TickOpener opener_;
  hal::CanFrame queue_[kQueueFrames];
  int first_ = 0;
  int size_ = 0;
  std::uint32_t dropped_ = 0;
  std::uint32_t refused_ticks_ = 0;
};

}  // namespace s4tp::processes
