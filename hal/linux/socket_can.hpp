#pragma once
/// CAN through a Linux network interface: order, patience and recovery on top of a bare socket.
///
/// \code
///   send -> queue -> socket -> driver -> bus        full socket or driver: the frame waits in the queue
///   receive <----------- socket <- filters <- bus   error frames become states and news on the way
/// \endcode
/// One thread. Nothing throws; after open() nothing allocates.

#include <cstdint>

#include "hal/linux/frame_socket.hpp"
#include "hal/linux/linux_can.hpp"
#include "hal/linux/restart_policy.hpp"

namespace s4tp::hal::linux_host {

class SocketCan final : public LinuxCan {
 public:
  static constexpr int kQueueFrames = 256;
  static constexpr std::uint64_t kLookMs = 100;  ///< between looks at the link

  /// \param socket  must outlive this
  explicit SocketCan(FrameSocket& socket) : socket_(socket) {}

  [[nodiscard]] bool open(Reason& reason);

  /// LINUX-001 Frames in the order of arrival; the controller's error frames are taken out on the way.
  [[nodiscard]] bool receive(CanFrame& frame) override;
  /// LINUX-002 While socket or driver have no room (EAGAIN, ENOBUFS), frames wait, in order, and are tried
  /// again by send(), receive() and wait(). LINUX-003 Refused and counted as dropped: a full queue, a bus
  /// that is off or down, and a frame that is no 11-bit data frame of a CAN (FD) length.
  [[nodiscard]] bool send(const CanFrame& frame) override;
  /// LINUX-004 kBusOff, kPassive and back as the controller reports them; a frame from another node proves it
  /// is not off. LINUX-005 kDown while the interface is down, gone or renamed; its queue is dropped, for it
  /// would be stale when the interface returns. LINUX-006 kActive again when it is back, found by its name.
  [[nodiscard]] CanState state() const override { return state_; }
  /// LINUX-007 dropped includes frames the socket had no room for (SO_RXQ_OVFL) and the controller's
  /// overflows; errors are the controller's reports and frames the socket refused.
  [[nodiscard]] CanCounters counters() const override { return counters_; }

  [[nodiscard]] bool wait(int timeout_ms) override;
  [[nodiscard]] std::uint64_t received_at_us() const override { return received_at_us_; }
  [[nodiscard]] bool take_news(LinkNews& news) override { return news_.take(news); }

  [[nodiscard]] int queued() const { return size_; }

 private:
  void flush();
  void look_after_link();
  void take_link(LinkState link);
  void drop_queue();
  void take_report(const ControllerReport& report);
  void set_state(CanState state, LinkNews news);
  [[nodiscard]] bool usable() const { return state_ == CanState::kActive || state_ == CanState::kPassive; }

  FrameSocket& socket_;
  CanState state_ = CanState::kDown;
  LinkState link_ = LinkState::kGone;
  CanCounters counters_;
  NewsBoard news_;
  RestartPolicy restart_;
  bool open_ = false;
  bool look_now_ = false;
  bool restart_refused_ = false;
  std::uint64_t looked_ms_ = 0;
  std::uint64_t received_at_us_ = 0;
  CanFrame queue_[kQueueFrames];
  int first_ = 0;
  int size_ = 0;
};

/// Whether CAN or CAN FD has frames of this many bytes: 0 .. 8, 12, 16, 20, 24, 32, 48, 64.
[[nodiscard]] bool is_can_length(std::uint8_t length);

}  // namespace s4tp::hal::linux_host
