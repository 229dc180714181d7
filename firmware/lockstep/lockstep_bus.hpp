#pragma once
/// The ECU's end of a bus in lock-step: what has arrived up to a TICK frame, tick by tick. For simulation
/// only: a car's ECU has a timer and obeys no TICK frame.
///
/// \code
///   bus      M S P T | M S T | M S ..     frames keep coming while the ECU works
///   tick n   M S P T |                    it gets these, and no frame of the next tick
/// \endcode

#include <cstdint>

#include "firmware/ecu/ecu_core.hpp"
#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"

namespace s4tp::lockstep {

/// Which TICK frames open a tick. Of random frames one in 256 has a CRC that fits, so number and counter have
/// to say the same.
class TickOpener {
 public:
  /// PROC-001 Opens on a TICK frame whose CRC fits and whose number and counter are both 1 .. kAheadMax
  /// further than the last one's: not on a damaged, repeated or invented one. At first, and after 1 s of
  /// silence, there may be another world: number 1 opens, and so does the second of two in a row.
  /// \param now_ms  of a local clock that never runs back
  [[nodiscard]] bool opens(const wire::Frame& frame, std::uint64_t now_ms);

  static constexpr int kAheadMax = 20;

 private:
  struct Place {
    std::uint16_t number = 0;
    std::uint8_t counter = 0;
    bool known = false;
  };
  [[nodiscard]] static bool follows(const Place& last, const Place& next);

  Place last_;       ///< opened a tick
  Place candidate_;  ///< did not, but may belong to another world
  std::uint64_t opened_ms_ = 0;
};

class LockstepBus final : public hal::Can {
 public:
  /// No more than the ECU takes in a tick: else it would work off a flood behind the world's back, and answer
  /// ticks that are long over. (A real bus carries 90 frames in 10 ms; in lock-step a tick lasts as long as
  /// it likes.)
  static constexpr int kQueueFrames = ecu::kMaxFramesPerTick;

  /// \param can  must outlive this
  explicit LockstepBus(hal::Can& can) : can_(can) {}

  /// Takes what has arrived, up to the next TICK frame that opens a tick, and no more than kQueueFrames a
  /// call. \return whether one opened
  [[nodiscard]] bool take_tick(std::uint64_t now_ms);

  /// PROC-002 Frames of the ticks opened so far, in order. A TICK frame that opens none is not handed on; of
  /// more than kQueueFrames the oldest are dropped and counted.
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return can_.send(frame); }
  [[nodiscard]] hal::CanState state() const override { return can_.state(); }
  [[nodiscard]] hal::CanCounters counters() const override;

  /// TICK frames that opened nothing.
  [[nodiscard]] std::uint32_t refused_ticks() const { return refused_ticks_; }

 private:
  /// \return whether this frame opened a tick
  [[nodiscard]] bool take(const hal::CanFrame& frame, std::uint64_t now_ms);

  hal::Can& can_;
  TickOpener opener_;
  wire::Frame queue_[kQueueFrames];
  int first_ = 0;
  int size_ = 0;
  std::uint32_t dropped_ = 0;
  std::uint32_t refused_ticks_ = 0;
};

}  // namespace s4tp::lockstep
