#include "hal/mps/slcan_can.hpp"

#include "hal/mps/interrupts.hpp"
#include "hal/phase_lock.hpp"

namespace s4tp::hal::mps {
namespace {

constexpr char kOpenAdapter[] = "C\rS6\rO\r";
constexpr int kTransmitInterrupt = kUart1Interrupts[1];
/// More than one byte at a time is there only when the line is faster than the handler.
constexpr int kBytesAnInterrupt = 16;

}  // namespace

void SlcanCan::start(std::uint32_t baud) {
  uart_.start(baud);
  uart_.enable_interrupts();
  for (const int number : kUart1Interrupts) start_interrupt(number);
  static_cast<void>(out_.push(kOpenAdapter, sizeof kOpenAdapter - 1));  // the first into an empty ring
  pend_interrupt(kTransmitInterrupt);
  state_ = CanState::kActive;
}

void SlcanCan::watch(std::uint32_t id, const Clock& clock) {
  watch_ = SlcanWatch(id);
  clock_ = &clock;
}

bool SlcanCan::take_arrival(std::uint32_t& phase_us) {
  const std::uint32_t arrival_us = arrival_us_.exchange(kNoArrival, std::memory_order_relaxed);
  if (arrival_us == kNoArrival) return false;
  phase_us = arrival_us;
  return true;
}

void SlcanCan::on_interrupt() {
  uart_.clear_interrupts();
  std::uint8_t received = 0;
  for (int i = 0; i < kBytesAnInterrupt && uart_.receive(received); ++i) {
    const char character = static_cast<char>(received);
    if (!in_.push(&character, 1)) ++lost_bytes_;
    if (clock_ != nullptr && watch_.take(character)) {
      const auto phase_us = static_cast<std::uint32_t>(clock_->now_us() % kTickPeriodUs);
      arrival_us_.store(phase_us, std::memory_order_relaxed);
    }
  }
  if (uart_.take_overrun()) ++lost_bytes_;
  char next = 0;
  for (int i = 0; i < kBytesAnInterrupt && out_.front(next); ++i) {
    if (!uart_.send(static_cast<std::uint8_t>(next))) return;  // the transmitter calls again when it has room
    out_.pop();
  }
}

bool SlcanCan::receive(CanFrame& frame) {
  char character = 0;
  for (std::uint32_t i = 0; i < kReceiveBytes && in_.front(character); ++i) {
    in_.pop();
    CanFrame read;
    const SlcanEvent event = parser_.take(character, read);
    if (event == SlcanEvent::kFrame) {
      frame = read;
      ++counters_.received;
      return true;
    }
    if (event == SlcanEvent::kGarbage || event == SlcanEvent::kRefused) ++counters_.errors;
  }
  return false;
}

bool SlcanCan::send(const CanFrame& frame) {
  char line[kSlcanLineSize];
  const int size = format_slcan(frame, line);
  if (size == 0 || state_ == CanState::kDown || !out_.push(line, static_cast<std::uint32_t>(size))) {
    ++counters_.dropped;
    return false;
  }
  ++counters_.sent;
  pend_interrupt(kTransmitInterrupt);
  return true;
}

CanCounters SlcanCan::counters() const {
  CanCounters counters = counters_;
  counters.errors += lost_bytes_.load(std::memory_order_relaxed);
  return counters;
}

}  // namespace s4tp::hal::mps
