/// The ECU image of a board: control in the timer interrupt, planning in the background. Its CAN bus is down
/// until a driver for one stands in hal/mps, so it stays in standby; boot line and one status line a second
/// go to the UART.

#include "algo/core/check.hpp"
#include "firmware/ecu/ecu.hpp"
#include "firmware/targets/text.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"
#include "hal/mps/uart.hpp"
#include "hal/mps/watchdog.hpp"

namespace s4tp::targets {
namespace {

constexpr std::uint32_t kBaud = 1'000'000;
constexpr std::uint32_t kWatchdogMs = 100;
constexpr std::uint32_t kTicksPerStatus = 100;

class NoBus final : public hal::Can {
 public:
  [[nodiscard]] bool receive(hal::CanFrame&) override { return false; }
  [[nodiscard]] bool send(const hal::CanFrame&) override {
    ++counters_.dropped;
    return false;
  }
  [[nodiscard]] hal::CanState state() const override { return hal::CanState::kDown; }
  [[nodiscard]] hal::CanCounters counters() const override { return counters_; }

 private:
  hal::CanCounters counters_;
};

NoBus bus;
hal::mps::Timer timer;
hal::mps::Uart uart;
hal::mps::CmsdkWatchdog watchdog;
ecu::Ecu<Planner> the_ecu;
volatile std::uint32_t ticks = 0;

void print_status() {
  Text line;
  line << "tick " << ticks << " mode " << static_cast<std::int32_t>(the_ecu.mode()) << " faults ";
  line.hex(the_ecu.faults(), 4) << " stack " << hal::mps::stack_used() << "\r\n";
  uart.print(line.c_str());
}

}  // namespace
}  // namespace s4tp::targets

void systick_handler() {
  using namespace s4tp::targets;
  timer.on_interrupt();
  if (!timer.take()) return;
  the_ecu.control_tick();
  ticks = ticks + 1;
}

void image_main() {
  using namespace s4tp;
  using namespace s4tp::targets;
  uart.start(kBaud);
  ecu::Ports ports;
  ports.can = &bus;
  ports.clock = &timer;
  ports.cycles = &timer;
  ports.watchdog = &watchdog;
  const Status status = the_ecu.init(Parameters{}, ports);
  Text boot;
  boot << "s4tp ecu: " << status_name(status) << ", no CAN driver\r\n";
  uart.print(boot.c_str());
  watchdog.start(kWatchdogMs);
  timer.start();
  for (std::uint32_t next_status = kTicksPerStatus;;) {
    if (the_ecu.planning_due()) the_ecu.planning_cycle();
    if (ticks >= next_status) {
      next_status += kTicksPerStatus;
      print_status();
    }
    __asm__ volatile("wfi");
  }
}

/// The timer stops with us, so the watchdog resets the processor.
void s4tp::assertion_failed(const char* expression, const char* file, int) {
  __asm__ volatile("cpsid i");
  targets::uart.print(expression);
  targets::uart.print(" failed in ");
  targets::uart.print(file);
  targets::uart.print("\r\n");
  for (;;) {
  }
}
