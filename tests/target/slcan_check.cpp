/// SLCAN on the board: answers each frame with the same one, its id one higher, while the background
/// computes. Frame 7FF ends it: what was counted is printed. slcan_check.py is at the other end of the line.

#include "firmware/targets/text.hpp"
#include "hal/mps/interrupts.hpp"
#include "hal/mps/semihosting.hpp"
#include "hal/mps/slcan_can.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"

using namespace s4tp::hal;

namespace {

constexpr std::uint32_t kLastId = 0x7FF;
constexpr std::uint32_t kWatchedId = 0x123;
constexpr int kFramesATick = 256;

mps::SlcanCan can;
mps::Timer timer;
bool driver_is_silent = false;
std::uint32_t arrivals = 0;  ///< MPS-043 ticks that found one noted

void finish() {
  const CanCounters counters = can.counters();
  s4tp::targets::Text line;
  line << "received " << counters.received << " sent " << counters.sent << " dropped " << counters.dropped
       << " errors " << counters.errors << " arrivals " << arrivals << " down before start "
       << (driver_is_silent ? "yes" : "no") << "\n";
  mps::semihosting::print(line.c_str());
  mps::semihosting::exit(0);
}

}  // namespace

void uart1_handler() {
  can.on_interrupt();
}

void systick_handler() {
  timer.on_interrupt();
  mps::pend_control_interrupt();
}

void pendsv_handler() {
  std::uint32_t arrival_us = 0;
  if (can.take_arrival(arrival_us)) ++arrivals;
  CanFrame frame;
  for (int i = 0; i < kFramesATick && can.receive(frame); ++i) {
    if (frame.id == kLastId) finish();
    ++frame.id;
    static_cast<void>(can.send(frame));
  }
}

void image_main() {
  CanFrame frame;
  driver_is_silent = can.state() == CanState::kDown && !can.send(frame) && !can.receive(frame);
  mps::start_control_interrupt();
  can.watch(kWatchedId, timer);
  can.start(kSlcanLeastBaud);
  timer.start();
  for (;;) {  // the background is busy: all happens in interrupts
  }
}
