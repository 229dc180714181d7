#pragma once
/// Bytes from one context to another; neither ever waits.

#include <atomic>
#include <cstdint>

namespace s4tp::hal::mps {

template <std::uint32_t N>
class ByteRing {
  static_assert(N > 0 && (N & (N - 1)) == 0, "a power of two: the counters wrap");

 public:
  /// Writer. \return false when there is no room for all of them: none is taken
  [[nodiscard]] bool push(const char* bytes, std::uint32_t size) {
    const std::uint32_t written = written_.load(std::memory_order_relaxed);
    if (N - (written - read_.load(std::memory_order_acquire)) < size) return false;
    for (std::uint32_t i = 0; i < size; ++i) bytes_[(written + i) % N] = bytes[i];
    written_.store(written + size, std::memory_order_release);
    return true;
  }
  /// Reader. \return false when there is none
  [[nodiscard]] bool front(char& byte) const {
    const std::uint32_t read = read_.load(std::memory_order_relaxed);
    if (written_.load(std::memory_order_acquire) == read) return false;
    byte = bytes_[read % N];
    return true;
  }
  /// Reader. \pre front() has given a byte
  void pop() { read_.store(read_.load(std::memory_order_relaxed) + 1U, std::memory_order_release); }
  /// Bytes ever pushed; wraps.
  [[nodiscard]] std::uint32_t written() const { return written_.load(std::memory_order_relaxed); }

 private:
  char bytes_[N] = {};
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> read_{0};
};

}  // namespace s4tp::hal::mps
