#pragma once
/// A bus with a second link beside it: track lists and the map come over the link, all else over the bus.

#include "firmware/wire/codec.hpp"
#include "hal/linux/linux_can.hpp"

namespace s4tp::processes {

/// PROC-045 Of the link the ids of track list and map and no others; of the bus all others and none of
/// these, so that no two nodes send the same message. PROC-046 Between two motion frames of the bus at most
/// kShare frames of the link are taken: a flood on it takes no room from the vehicle's frames.
class InputLink final : public hal::linux_host::LinuxCan {
 public:
  static constexpr int kShare = 32;

  /// Both must outlive this.
  InputLink(hal::linux_host::LinuxCan& bus, hal::linux_host::LinuxCan& link) : bus_(bus), link_(link) {}

  [[nodiscard]] bool receive(hal::CanFrame& frame) override {
    while (taken_ < kShare && link_.receive(frame)) {
      ++taken_;
      from_link_ = true;
      if (is_input(frame.id)) return true;
    }
    from_link_ = false;
    while (bus_.receive(frame)) {
      if (frame.id == wire::kMotionId) taken_ = 0;
      if (!is_input(frame.id)) return true;
    }
    return false;
  }
  [[nodiscard]] bool send(const hal::CanFrame& frame) override { return bus_.send(frame); }
  [[nodiscard]] hal::CanState state() const override { return bus_.state(); }
  [[nodiscard]] hal::CanCounters counters() const override { return bus_.counters(); }
  [[nodiscard]] bool wait(int timeout_ms) override {
    (void)link_.wait(0);
    return bus_.wait(timeout_ms);
  }
  [[nodiscard]] std::uint64_t received_at_us() const override {
    return from_link_ ? link_.received_at_us() : bus_.received_at_us();
  }
  [[nodiscard]] bool take_news(hal::linux_host::LinkNews& news) override { return bus_.take_news(news); }

  [[nodiscard]] static constexpr bool is_input(std::uint32_t id) {
    return (id >= wire::kTrackListId && id <= wire::kTrackMotionId) ||
           (id >= wire::kMapHeaderId && id <= wire::kConflictSecondId);
  }

 private:
  hal::linux_host::LinuxCan& bus_;
  hal::linux_host::LinuxCan& link_;
  int taken_ = 0;  ///< of the link since the last motion frame
  bool from_link_ = false;
};

}  // namespace s4tp::processes
