#pragma once
/// The control tick of a board whose world is simulated: opens on each TICK frame, as on the host.
///
/// \code
///   vehicle time    k*100      +10       +20  ..  +90      (k+1)*100
///   control      ---| tick |----| tick |---- .. ---| tick |---[held]---| tick |---
///   planning        |..[ plan()  interrupted by the ticks .........  ]|
/// \endcode
/// The world answers at once, so it would leave a processor's planning behind. Therefore the tick that passes
/// a boundary waits for it (logical execution time), and only that one: the commands are the host's, to the
/// bit, whatever the processor's speed, and control still preempts planning.

#include "firmware/ecu/ecu.hpp"
#include "firmware/lockstep/lockstep_bus.hpp"
#include "hal/clock.hpp"
#include "hal/mps/slcan_can.hpp"
#include "hal/tick.hpp"
#include "hal/watchdog.hpp"

namespace s4tp::targets {

class LockstepTick final : public hal::Tick {
 public:
  struct Ports {
    lockstep::LockstepBus& bus;      ///< the ECU's
    const hal::mps::SlcanCan& line;  ///< below it
    const hal::Clock& clock;         ///< of the board
    hal::Watchdog& watchdog;
    const ecu::Ecu<planner::Planner>& ecu;
  };
  explicit LockstepTick(const Ports& ports) : ports_(ports) {}

  /// TARGET-010 Whether the world's next tick is here and may begin. To be asked in each timer interrupt:
  /// kicks the watchdog, for waiting for the world is no fault. TARGET-011 Until the first one it says ten
  /// times a second that it is there, with a VersionEcu frame.
  [[nodiscard]] bool take() override;
  void adjust(std::int32_t /*phase_us*/) override {}

 private:
  [[nodiscard]] bool arrives();
  [[nodiscard]] bool has_to_wait() const;
  void say_hello();

  Ports ports_;
  ecu::Reporter hello_;
  std::uint64_t hello_us_ = 0;
  std::uint32_t heard_bytes_ = 0;
  bool arrived_ = false;
  bool begun_ = false;
};

}  // namespace s4tp::targets
