#pragma once
/// Hands the newest value from one context to another; neither ever waits.
///
/// \code
///   writer: back() fill publish()      [ back ] <-> [ middle ] <-> [ front ]      reader: refresh() front()
/// \endcode
/// Each side owns one slot, the third is exchanged by one atomic operation.

#include <atomic>
#include <cstdint>

namespace s4tp::ecu {

/// ECU-080 Newest wins: the reader sees the last value published whole, or the one it saw before.
template <typename T>
class TripleBuffer {
 public:
  /// Writer: the slot to fill. Holds an old value.
  [[nodiscard]] T& back() { return slots_[back_]; }
  /// Writer: makes back() the newest value.
  void publish() {
    const std::uint8_t fresh = static_cast<std::uint8_t>(back_ | kFresh);
    back_ = static_cast<std::uint8_t>(middle_.exchange(fresh, std::memory_order_acq_rel) & kIndex);
  }

  /// Reader: takes the newest value if there is a new one. \return whether there was
  [[nodiscard]] bool refresh() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = static_cast<std::uint8_t>(middle_.exchange(front_, std::memory_order_acq_rel) & kIndex);
    return true;
  }
  /// Reader: the value taken last.
  [[nodiscard]] const T& front() const { return slots_[front_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  T slots_[3] = {};
  std::uint8_t back_ = 0;   ///< writer's
  std::uint8_t front_ = 1;  ///< reader's
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace s4tp::ecu
