#pragma once
/// Plays a recorded drive into the ECU and compares what comes out with what was recorded, bit by bit.
///
/// The log is candump's text, all frames of the bus in their order: the world's frames of a tick, its Tick
/// frame, then what the ECU answered. Comment lines carry what frames cannot:
///
/// \code
///     # s4tp log: ..., parameters 439041101, ...   CRC-32 of the parameters driven with: only those replay
///     # miss                                       the planning cycle that is running misses its deadline
/// \endcode
/// TARGET-001 Every frame the ECU sends has its equal, in order, among those recorded; the first difference
/// is shown with both.

#include <cstdint>

#include "algo/core/crc32.hpp"
#include "algo/core/parameters.hpp"
#include "algo/planner/planner.hpp"
#include "firmware/ecu/ecu.hpp"
#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"
#include "hal/sim/null_devices.hpp"

namespace s4tp::targets {

/// First in, first out, in fixed memory.
class FrameQueue {
 public:
  [[nodiscard]] bool push(const wire::Frame& frame);
  [[nodiscard]] bool pop(wire::Frame& frame);

 private:
  static constexpr int kCapacity = 512;
  wire::Frame frames_[kCapacity];
  int first_ = 0;
  int size_ = 0;
};

/// The ECU's end of a bus whose other end is the log.
class LogCan final : public hal::Can {
 public:
  [[nodiscard]] bool receive(hal::CanFrame& frame) override;
  [[nodiscard]] bool send(const hal::CanFrame& frame) override;
  [[nodiscard]] hal::CanState state() const override { return hal::CanState::kActive; }
  [[nodiscard]] hal::CanCounters counters() const override { return counters_; }

  FrameQueue to_ecu;
  FrameQueue from_ecu;

 private:
  hal::CanCounters counters_;
};

class Replay {
 public:
  /// \return false when the ECU refuses to start
  [[nodiscard]] bool init(const Parameters& parameters);
  /// One line of the log without its end.
  void line(const char* text, int size);
  /// After the last line.
  void finish();

  [[nodiscard]] bool identical() const { return differences_ == 0 && compared_ > 0; }
  /// TARGET-002 The log can be judged: well formed, complete, and driven with these parameters.
  [[nodiscard]] bool valid() const { return valid_ && ticks_ > 0; }
  void print_summary() const;

  [[nodiscard]] planner::Planner& planner() { return ecu_.planner(); }

 private:
  void comment(const char* text, int size);
  void tick();
  void compare(const wire::Frame& recorded);
  void expect_nothing_left();
  void differs(const wire::Frame* recorded, const wire::Frame* sent);
  void invalid(const char* reason);

  ecu::Ecu<planner::Planner> ecu_;
  LogCan can_;
  hal::sim::NullCycleCounter cycles_;
  hal::sim::NullWatchdog watchdog_;
  std::uint32_t parameters_crc_ = 0;
  bool valid_ = true;
  std::uint32_t lines_ = 0;
  std::uint32_t ticks_ = 0;
  std::uint32_t planning_cycles_ = 0;
  std::uint32_t misses_ = 0;
  std::uint32_t compared_ = 0;
  std::uint32_t differences_ = 0;
  std::uint32_t crc_ = kCrc32Start;  ///< CRC-32 over id and data of every frame sent
};

}  // namespace s4tp::targets
