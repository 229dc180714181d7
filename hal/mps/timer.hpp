#pragma once
/// SysTick as the control tick, the local clock and the cycle counter. The image calls on_interrupt()
/// from its systick_handler().

#include "hal/clock.hpp"
#include "hal/cycle_counter.hpp"
#include "hal/tick.hpp"

namespace s4tp::hal::mps {

class Timer final : public Tick, public Clock, public CycleCounter {
 public:
  /// \param tick_us  at most 500'000
  void start(std::uint32_t tick_us = 10'000);
  void on_interrupt();

  /// MPS-010 One tick each `tick_us`; ticks not taken in time are lost, not queued.
  [[nodiscard]] bool take() override;
  /// MPS-011 Lengthens or shortens the next period by at most 500 us.
  void adjust(std::int32_t phase_us) override;
  /// MPS-013 When the newest tick was due, on the clock of now_us(), modulo the tick's period: for
  /// phase_shift_us(). The loop it closes acts a period late, as the hardware takes a new period when one ends.
  [[nodiscard]] std::uint32_t due_phase_us() const;
  /// MPS-012 Never runs backwards.
  [[nodiscard]] std::uint64_t now_us() const override;
  /// Core clock cycles since start().
  [[nodiscard]] std::uint32_t now() const override;

 private:
  [[nodiscard]] std::uint64_t cycles() const;

  std::uint32_t tick_cycles_ = 0;
  volatile std::uint64_t elapsed_cycles_ = 0;    ///< of the periods that have ended
  volatile std::uint32_t period_cycles_ = 0;     ///< of the period running now
  volatile std::uint32_t due_phase_cycles_ = 0;  ///< of the last interrupt, within a tick
  volatile std::int32_t phase_us_ = 0;
  volatile bool due_ = false;
};

}  // namespace s4tp::hal::mps
