/// Checks hal/mps on the board itself. Exit code 0 when all holds; else the line that does not is printed.

#include "hal/mps/board.hpp"
#include "hal/mps/semihosting.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"
#include "hal/mps/uart.hpp"
#include "hal/mps/watchdog.hpp"
#include "hal/phase_lock.hpp"

using namespace s4tp::hal;
using namespace s4tp::hal::mps;

namespace {

constexpr std::uint32_t kTickCycles = kCoreClockHz / 100;
constexpr std::uint32_t kUsCycles = kCoreClockHz / 1'000'000;
/// Outside what start-up clears, so it lives through a reset.
constexpr std::uintptr_t kSurvivor = 0x20040000;
constexpr std::uint32_t kWasHere = 0x5A5A1234;

Timer timer;
volatile std::uint32_t last_interrupt = 0;
volatile std::uint32_t interval = 0;
volatile std::uint32_t interrupts = 0;

void demand(bool holds, const char* what) {
  if (holds) return;
  semihosting::print("does not hold: ");
  semihosting::print(what);
  semihosting::print("\n");
  semihosting::exit(1);
}

std::uint32_t next_interval() {
  const std::uint32_t before = interrupts;
  while (interrupts == before) {
  }
  return interval;
}

bool near(std::uint32_t cycles, std::uint32_t expected) {
  const std::uint32_t difference = cycles > expected ? cycles - expected : expected - cycles;
  return difference < 20 * kUsCycles;
}

__attribute__((noinline)) std::uint8_t use_stack() {
  volatile std::uint8_t room[2048];
  for (volatile std::uint8_t& byte : room) byte = 1;
  return room[interrupts % 2048];
}

// MPS-001: 2048 bytes of locals show in the paint.
void check_stack() {
  const std::uint32_t before = stack_used();
  demand(before > 0 && before < 1024, "little stack is used at first");
  demand(use_stack() == 1 && stack_used() >= 2048 && stack_used() < stack_size(), "2048 bytes more show");
}

// MPS-010, MPS-011: 10 ms a tick; 500 us more or less at most, and only once.
void check_ticks() {
  timer.start();
  (void)next_interval();
  (void)next_interval();
  demand(near(next_interval(), kTickCycles), "10 ms a tick");
  (void)timer.take();
  demand(!timer.take(), "a tick can be taken once");
  (void)next_interval();
  (void)next_interval();
  demand(timer.take() && !timer.take(), "two ticks not taken are one");
  struct {
    std::int32_t asked_us;
    std::uint32_t tick_us;
  } const cases[] = {{300, 10'300}, {9'000, 10'500}, {-300, 9'700}, {-9'000, 9'500}};
  for (const auto& one : cases) {
    timer.adjust(one.asked_us);
    (void)next_interval();  // the period running when we asked
    (void)next_interval();  // the one whose reload value was already set
    demand(near(next_interval(), one.tick_us * kUsCycles),
           "an adjusted tick is as long as asked, within limits");
    demand(near(next_interval(), kTickCycles), "the next one is 10 ms again");
  }
}

// MPS-013: ticks come 4 ms after motion frames of any phase whose sender's clock is 100 ppm slower. A shift acts a period
// late, so what is on its way when the lead is reached is overshot, by 1 ms at most; after 60 ticks within 50 us.
void check_phase_lock() {
  constexpr std::uint64_t kMotionUs = 10'001;
  for (std::uint32_t phase_us = 0; phase_us < 10'000; phase_us += 2'500) {
    std::uint64_t motion_us = timer.now_us() + phase_us;
    for (int i = 0; i < 90; ++i) {
      (void)next_interval();
      const std::uint64_t now_us = timer.now_us();
      while (motion_us + kMotionUs <= now_us) motion_us += kMotionUs;
      const auto lead_us = static_cast<std::uint32_t>(now_us - motion_us);
      demand(i < 60 || (lead_us > 3'950 && lead_us < 4'050),
             "the tick keeps its distance to the motion frames");
      timer.adjust(phase_shift_us(motion_us, kTickLeadUs, timer.due_phase_us()));
    }
  }
  timer.adjust(0);
}

// MPS-012: many readings around several ends of the period.
void check_clock() {
  std::uint64_t last_us = timer.now_us();
  for (const std::uint32_t end = interrupts + 5; interrupts < end;) {
    const std::uint64_t now_us = timer.now_us();
    demand(now_us >= last_us && now_us - last_us < 100, "the clock neither runs back nor jumps");
    last_us = now_us;
  }
}

// MPS-020, MPS-021: the test sends one 'A'.
void check_uart() {
  Uart uart;
  uart.start(1'000'000);
  std::uint8_t byte = 0;
  while (!uart.receive(byte)) {
  }
  demand(byte == 'A', "the byte sent arrives");
  demand(!uart.receive(byte), "and no other");
  demand(uart.send('B') && uart.send('\n'), "the transmitter takes bytes");
}

// MPS-030: with kicks it lives four time-outs long, without them it is reset.
void check_watchdog() {
  CmsdkWatchdog watchdog;
  watchdog.start(20);
  for (int i = 0; i < 8; ++i) {
    (void)next_interval();
    watchdog.kick();
  }
  reg(kSurvivor) = kWasHere;
  for (const std::uint32_t end = interrupts + 20; interrupts < end;) {
  }
  demand(false, "the watchdog resets");
}

}  // namespace

void systick_handler() {
  timer.on_interrupt();
  const std::uint32_t now = timer.now();
  interval = now - last_interrupt;
  last_interrupt = now;
  interrupts = interrupts + 1;
}

void image_main() {
  if (reg(kSurvivor) == kWasHere) {
    semihosting::print("reset by the watchdog, as it should\n");
    semihosting::exit(0);
  }
  check_stack();
  check_ticks();
  check_clock();
  check_phase_lock();
  check_uart();
  check_watchdog();
}
