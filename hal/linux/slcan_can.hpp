#pragma once
/// CAN as text over a byte link: an adapter, an emulated board, or another process of ours at the other end.

#include <cstdint>

#include "hal/linux/byte_link.hpp"
#include "hal/linux/linux_can.hpp"
#include "hal/slcan.hpp"

namespace s4tp::hal::linux_host {

class SlcanCan final : public LinuxCan {
 public:
  static constexpr int kQueueBytes = 256 * kSlcanLineSize;
  static constexpr std::uint64_t kRetryMs = 100;  ///< between attempts to get a lost peer back

  /// \pre link is open; it must outlive this
  explicit SlcanCan(ByteLink& link) : link_(link) { filter(nullptr, 0); }

  /// The 11-bit ids to receive; copied. Without this call, all.
  void filter(const std::uint32_t* ids, int count);

  /// LINUX-050 Frames in the order of arrival. What is no frame of ours is read over; garbage and an
  /// adapter's no count as errors.
  [[nodiscard]] bool receive(CanFrame& frame) override;
  /// LINUX-051 What the link does not take now waits, in order. Refused and counted as dropped: a full queue,
  /// a peer that is not there, and a frame that has no SLCAN line.
  [[nodiscard]] bool send(const CanFrame& frame) override;
  /// LINUX-052 kDown without a peer; what waited for it is dropped. Each peer is told to open at 500 kbit/s
  /// first.
  [[nodiscard]] CanState state() const override { return state_; }
  [[nodiscard]] CanCounters counters() const override { return counters_; }

  [[nodiscard]] bool wait(int timeout_ms) override;
  [[nodiscard]] std::uint64_t received_at_us() const override { return received_at_us_; }
  [[nodiscard]] bool take_news(LinkNews& news) override { return news_.take(news); }

 private:
  [[nodiscard]] bool wanted(std::uint32_t id) const { return (wanted_[id / 64] >> (id % 64) & 1U) != 0; }
  void look_after_link();
  void flush();
  void put(const char* text, int size);

  ByteLink& link_;
  SlcanParser parser_;
  CanState state_ = CanState::kDown;
  CanCounters counters_;
  NewsBoard news_;
  bool seen_ = false;  ///< a peer was there before
  std::uint64_t tried_ms_ = 0;
  std::uint64_t received_at_us_ = 0;
  std::uint64_t wanted_[2048 / 64];  ///< one bit an id
  char in_[4096];
  int in_next_ = 0;
  int in_size_ = 0;
  char out_[kQueueBytes];
  int out_first_ = 0;
  int out_size_ = 0;
  int out_frames_ = 0;  ///< lines queued since the queue was last empty
};

}  // namespace s4tp::hal::linux_host
