#pragma once
/// Time that went to interrupts, to be taken off what they interrupted. One for an image.

#include <cstdint>

#include "hal/cycle_counter.hpp"

namespace s4tp::targets {

class InterruptMeter {
 public:
  explicit InterruptMeter(const hal::CycleCounter& counter) : counter_(counter) {}

  /// To stand first in every handler; in the timer's, after the timer knows of the period that ended.
  class Guard {
   public:
    explicit Guard(InterruptMeter& meter) : meter_(meter) { meter_.enter(); }
    ~Guard() { meter_.leave(); }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

   private:
    InterruptMeter& meter_;
  };

  /// Thread context: the counter without the interrupts.
  [[nodiscard]] std::uint32_t own_counts() const {
    __asm__ volatile("cpsid i" ::: "memory");
    const std::uint32_t counts = counter_.now() - interrupts_;
    __asm__ volatile("cpsie i" ::: "memory");
    return counts;
  }

 private:
  void enter() {
    __asm__ volatile("cpsid i" ::: "memory");
    if (depth_++ == 0) began_ = counter_.now();
    __asm__ volatile("cpsie i" ::: "memory");
  }
  void leave() {
    __asm__ volatile("cpsid i" ::: "memory");
    if (--depth_ == 0) interrupts_ += counter_.now() - began_;
    __asm__ volatile("cpsie i" ::: "memory");
  }

  const hal::CycleCounter& counter_;
  std::uint32_t depth_ = 0;  ///< handlers that interrupt one another
  std::uint32_t began_ = 0;
  std::uint32_t interrupts_ = 0;
};

}  // namespace s4tp::targets
