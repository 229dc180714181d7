#pragma once
/// Bounded queue from one context to another; neither ever waits.

#include <atomic>
#include <cstdint>

namespace s4tp::ecu {

/// ECU-081 First in, first out; a full ring drops the new event and counts it.
/// Events are written and read in place, so that large ones are never copied.
template <typename T, std::uint32_t N>
class EventRing {
  static_assert(N > 0 && (N & (N - 1)) == 0, "a power of two: the counters wrap");

 public:
  /// Writer: the slot of the next event, to be filled and published. Holds an old event.
  /// \return nullptr, counted as dropped, when the ring is full
  [[nodiscard]] T* claim() {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == N) {
      ++dropped_;
      return nullptr;
    }
    return &slots_[written % N];
  }
  void publish() { written_.store(written_.load(std::memory_order_relaxed) + 1U, std::memory_order_release); }
  /// Writer: whether the reader has taken everything.
  [[nodiscard]] bool drained() const {
    return written_.load(std::memory_order_relaxed) == read_.load(std::memory_order_acquire);
  }
  [[nodiscard]] std::uint32_t dropped() const { return dropped_; }

  /// Reader: the oldest event, its own until pop(). \return nullptr when there is none
  [[nodiscard]] const T* front() const {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (written_.load(std::memory_order_acquire) == read) return nullptr;
    return &slots_[read % N];
  }
  void pop() { read_.store(read_.load(std::memory_order_relaxed) + 1U, std::memory_order_release); }

 private:
  T slots_[N] = {};
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> read_{0};
  std::uint32_t dropped_ = 0;  ///< writer's
};

}  // namespace s4tp::ecu
