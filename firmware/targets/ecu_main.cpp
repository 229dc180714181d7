/// The ECU image of a board: control in an interrupt of its own, which the timer asks for; planning in the
/// background; CAN as SLCAN on UART 1. UART 0 is the console: boot line, a status line a second, last words.
///
/// Built twice. `ecu` is the car's: a control tick each 10 ms, 4 ms after the motion frame (hal/phase_lock.hpp). `ecu_lockstep` drives in a simulated world,
/// whose TICK frames open its ticks; it also prints what each planning cycle cost. What a simulation may do,
/// no bus of a car may: `ecu` knows no TICK frame.

#include "algo/core/check.hpp"
#include "firmware/ecu/ecu.hpp"
#include "firmware/targets/interrupt_meter.hpp"
#include "firmware/targets/text.hpp"
#include "firmware/wire/codec.hpp"
#include "hal/mps/interrupts.hpp"
#include "hal/mps/memory_bank.hpp"
#include "hal/mps/slcan_can.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"
#include "hal/mps/uart.hpp"
#include "hal/mps/watchdog.hpp"
#include "hal/phase_lock.hpp"
#ifdef S4TP_LOCKSTEP
#include "firmware/targets/lockstep_tick.hpp"
#include "firmware/targets/paced_probe.hpp"
#include "firmware/targets/platform.hpp"
#include "firmware/targets/stage_counter.hpp"
#endif

extern "C" const std::uint8_t weights_bank_begin[];  // toolchain/linker
extern "C" const std::uint8_t weights_bank_end[];

namespace s4tp::targets {
namespace {

constexpr std::uint32_t kBaud = 1'000'000;
constexpr std::uint32_t kTicksPerStatus = 100;

hal::mps::Timer timer;
hal::mps::Uart console;
hal::mps::SlcanCan can;
hal::mps::CmsdkWatchdog watchdog;
const hal::mps::MemoryBank weights(weights_bank_begin, weights_bank_end);
ecu::Ecu<planner::Planner> the_ecu;
InterruptMeter meter(timer);
volatile std::uint32_t ticks = 0;
volatile bool planning = false;
volatile std::uint32_t timer_interrupts = 0;
volatile std::uint32_t ticks_of_cycle = 0;  ///< control ticks since the one that asked for planning
volatile std::uint32_t preemptions = 0;     ///< those of them that interrupted it
volatile std::uint32_t control_counts = 0;  ///< of the last control tick, what interrupted it included

#ifdef S4TP_LOCKSTEP
constexpr const char* kTickName = ", lock-step";
constexpr std::uint32_t kTimerUs = 1000;  // how often it looks for the world's tick
constexpr std::uint32_t kWatchdogMs =
    10'000;  // a sleeping processor's time jumps when its emulator's host is busy
lockstep::LockstepBus bus(can);
LockstepTick tick({bus, can, timer, watchdog, the_ecu});
StageCounter stages;
PacedProbe probe(stages, {ticks_of_cycle, timer_interrupts});

void begin_cycle() {
  preemptions = 0;
  probe.begin_cycle();
}

/// "cycle", then what it took: counts of each stage, ticks that interrupted it, counts of a control tick.
void print_cycle() {
  Text line;
  line << "cycle";
  for (int i = 0; i < planner::kStageCount; ++i)
    line << " " << StageCounter::name(i) << " " << stages.row(i).last;
  line << " preemptions " << preemptions << " control " << control_counts << "\n";
  console.print(line.c_str());
}
#else
constexpr const char* kTickName = "";
constexpr std::uint32_t kTimerUs = 10'000;
constexpr std::uint32_t kWatchdogMs = 100;
hal::mps::SlcanCan& bus = can;
hal::mps::Timer& tick = timer;
void begin_cycle() {}
void print_cycle() {}
#endif

/// The car's tick keeps its distance to the motion frames; a simulated world opens its ticks itself.
void keep_phase() {
  std::uint32_t arrival_us = 0;
  if (can.take_arrival(arrival_us)) {
    tick.adjust(hal::phase_shift_us(arrival_us, hal::kTickLeadUs, timer.due_phase_us()));
  }
}

void print_status() {
  Text line;
  line << "tick " << ticks << " at " << static_cast<std::uint32_t>(timer.now_us() / 1000) << " ms mode "
       << static_cast<std::int32_t>(the_ecu.mode()) << " faults ";
  line.hex(the_ecu.faults(), 5) << " stack " << hal::mps::stack_used() << " CAN errors "
                                << can.counters().errors << " dropped " << bus.counters().dropped << "\n";
  console.print(line.c_str());
}

void control() {
  if (planning) preemptions = preemptions + 1;
  const bool was_due = the_ecu.planning_due();
  const std::uint32_t began = timer.now();
  the_ecu.control_tick();
  control_counts = timer.now() - began;
  ticks_of_cycle = the_ecu.planning_due() && !was_due ? 0 : ticks_of_cycle + 1;
  ticks = ticks + 1;
}

void plan() {
  begin_cycle();
  planning = true;
  the_ecu.planning_cycle();
  planning = false;
  print_cycle();
}

/// The timer stops with us, so the watchdog resets the processor.
[[noreturn]] void stop_with(const char* first, const char* second, const char* third) {
  __asm__ volatile("cpsid i");
  console.print(first);
  console.print(second);
  console.print(third);
  console.print("\n");
  for (;;) {
  }
}

}  // namespace
}  // namespace s4tp::targets

using namespace s4tp::targets;

void uart1_handler() {
  const InterruptMeter::Guard guard(meter);
  can.on_interrupt();
}

void systick_handler() {
  timer.on_interrupt();  // before anybody reads the time
  timer_interrupts = timer_interrupts + 1;
  const InterruptMeter::Guard guard(meter);
  s4tp::hal::mps::pend_control_interrupt();
}

void pendsv_handler() {
  const InterruptMeter::Guard guard(meter);
  if (tick.take()) {
    keep_phase();
    control();
  }
  // Asked for again while it ran: not before the next period, so that planning has its turn.
  s4tp::hal::mps::forget_control_interrupt();
}

void fault_handler() {
  stop_with("fault of the core", "", "");
}

void s4tp::assertion_failed(const char* expression, const char* file, int) {
  stop_with(expression, " failed in ", file);
}

#ifdef S4TP_LOCKSTEP
std::uint32_t s4tp::targets::counts_now() {
  return meter.own_counts();
}
#endif

void image_main() {
  console.start(kBaud);
  s4tp::ecu::Ports ports;
  ports.can = &bus;
  ports.cycles = &timer;
  ports.watchdog = &watchdog;
  ports.weights = &weights;
  const s4tp::Status status = the_ecu.init(s4tp::Parameters{}, ports);
#ifdef S4TP_LOCKSTEP
  the_ecu.planner().probe = &probe;
#endif
  Text boot;
  boot << "s4tp ecu: " << status_name(status) << kTickName << "\n";
  console.print(boot.c_str());
  s4tp::hal::mps::start_control_interrupt();
  can.watch(s4tp::wire::kMotionId, timer);
  can.start(kBaud);
  watchdog.start(kWatchdogMs);
  timer.start(kTimerUs);
  for (std::uint32_t next_status = kTicksPerStatus;;) {
    if (the_ecu.planning_due()) plan();
    if (ticks >= next_status) {
      next_status += kTicksPerStatus;
      print_status();
    }
    s4tp::hal::mps::wait_for_interrupt();
  }
}
