#include "firmware/targets/lockstep_tick.hpp"

#include "hal/mps/interrupts.hpp"

namespace s4tp::targets {
namespace {

constexpr std::uint64_t kHelloEveryUs = 100'000;
constexpr std::uint64_t kSilenceUs = 1000;
constexpr std::uint32_t kPlanningMs = static_cast<std::uint32_t>(kStepMs);
/// Interrupts while a tick's frames come in: more than one a byte, of 512 frames at most.
constexpr int kInterruptsATick = 4 * lockstep::LockstepBus::kQueueFrames * hal::kSlcanLineSize;

}  // namespace

bool LockstepTick::take() {
  ports_.watchdog.kick();
  if (!arrived_) arrived_ = arrives();
  if (!begun_ && !arrived_) say_hello();
  if (!arrived_ || has_to_wait()) return false;
  arrived_ = false;
  begun_ = true;
  return true;
}

/// A tick that has begun to arrive is awaited asleep: a UART of QEMU's takes its next byte soon only while
/// the processor sleeps.
bool LockstepTick::arrives() {
  std::uint64_t heard_us = ports_.clock.now_us();
  for (int i = 0; i < kInterruptsATick; ++i) {
    ports_.watchdog.kick();
    const std::uint64_t now_us = ports_.clock.now_us();
    const std::uint32_t bytes = ports_.line.bytes_received();
    if (ports_.bus.take_tick(now_us / 1000U)) return true;
    if (bytes != heard_bytes_) {
      heard_bytes_ = bytes;
      heard_us = now_us;
    } else if (i == 0 || now_us - heard_us > kSilenceUs) {
      return false;
    }
    hal::mps::wait_for_interrupt();
  }
  return false;
}

bool LockstepTick::has_to_wait() const {
  const std::uint32_t now_ms = ports_.ecu.core().now_ms();
  const bool boundary = (now_ms + ecu::kTickMs) / kPlanningMs != now_ms / kPlanningMs;
  return boundary && ports_.ecu.planning_due();
}

void LockstepTick::say_hello() {
  const std::uint64_t now_us = ports_.clock.now_us();
  if (now_us - hello_us_ < kHelloEveryUs) return;
  hello_us_ = now_us;
  hello_.version(ports_.bus, ports_.ecu.core().weights());
}

}  // namespace s4tp::targets
