#include "firmware/targets/platform.hpp"
#include "hal/mps/startup.hpp"
#include "hal/mps/timer.hpp"

namespace {
s4tp::hal::mps::Timer timer;
}

void systick_handler() {
  timer.on_interrupt();
}

namespace s4tp::targets {

void start_counting() {
  timer.start();
}
std::uint32_t counts_now() {
  return timer.now();
}

}  // namespace s4tp::targets
