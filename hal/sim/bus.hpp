#pragma once
/// A CAN bus inside one process: what one port sends, every other attached port receives, in order.
/// One thread; nothing is lost but by a full queue, a bus that is off, or the fault hook.

#include <cstdint>

#include "hal/can.hpp"

namespace s4tp::hal::sim {

/// Told of every frame that reaches a port, before it can be taken (tick sources, recorders).
class FrameListener {
 public:
  virtual void frame_arrived(const CanFrame& frame) = 0;

 protected:
  ~FrameListener() = default;
};

/// Planted faults: sees each frame on its way and may change it.
class BusFault {
 public:
  /// \return false: the frame is lost for everybody
  [[nodiscard]] virtual bool pass(CanFrame& frame) = 0;

 protected:
  ~BusFault() = default;
};

class Bus {
 public:
  static constexpr int kMaxPorts = 4;
  static constexpr int kQueueFrames = 512;  ///< per port, frames received and not yet taken

  class Port final : public Can {
   public:
    /// HAL-001 Frames come out in the order they were sent; a port never hears itself.
    [[nodiscard]] bool receive(CanFrame& frame) override;
    /// HAL-002 A receiver whose queue is full loses the frame and counts it; the others get it.
    /// \return false, counted as dropped, while the bus is off or down
    [[nodiscard]] bool send(const CanFrame& frame) override;
    [[nodiscard]] CanState state() const override { return state_; }
    [[nodiscard]] CanCounters counters() const override { return counters_; }

    void set_state(CanState state) { state_ = state; }  ///< planted: bus-off and back
    FrameListener* listener = nullptr;                  ///< optional; not owned

   private:
    friend class Bus;
    void deliver(const CanFrame& frame);

    Bus* bus_ = nullptr;
    CanState state_ = CanState::kActive;
    CanCounters counters_;
    CanFrame queue_[kQueueFrames];
    int first_ = 0;
    int size_ = 0;
  };

  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// A new port. \return nullptr when all are taken
  [[nodiscard]] Port* attach();

  BusFault* fault = nullptr;  ///< optional; not owned

 private:
  Port ports_[kMaxPorts];
  int attached_ = 0;
};

}  // namespace s4tp::hal::sim
