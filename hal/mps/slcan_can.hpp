#pragma once
/// CAN as text over UART 1: a serial CAN adapter, or a host that speaks like one, at the other end of the
/// line. The image calls on_interrupt() from its uart1_handler().

#include <atomic>
#include <cstdint>

#include "hal/can.hpp"
#include "hal/clock.hpp"
#include "hal/mps/byte_ring.hpp"
#include "hal/mps/uart.hpp"
#include "hal/slcan.hpp"

namespace s4tp::hal::mps {

class SlcanCan final : public Can {
 public:
  static constexpr std::uint32_t kReceiveBytes = 2048;  ///< 10 ms of a line of 2 Mbaud
  static constexpr std::uint32_t kTransmitBytes = 512;  ///< 23 frames; a control tick sends at most 6

  /// MPS-040 Tells the adapter to open at 500 kbit/s. \param baud  kSlcanLeastBaud or more
  void start(std::uint32_t baud);
  void on_interrupt();
  /// Before start(): from then on the arrival of each frame of this id is noted. \param clock  must outlive this
  void watch(std::uint32_t id, const Clock& clock);
  /// MPS-043 When the newest frame watched for ended, modulo the tick's period; asking takes it.
  /// \return false when none has come since
  [[nodiscard]] bool take_arrival(std::uint32_t& phase_us);

  /// MPS-041 Frames in the order of arrival. What is no frame of ours is read over; garbage, an adapter's no,
  /// and bytes that came too fast count as errors.
  [[nodiscard]] bool receive(CanFrame& frame) override;
  /// MPS-042 Queues the whole line or nothing: refused and counted as dropped are a full queue and a frame
  /// that has no SLCAN line.
  [[nodiscard]] bool send(const CanFrame& frame) override;
  /// A line without handshake cannot tell whether anybody is there: kActive from start() on.
  [[nodiscard]] CanState state() const override { return state_; }
  [[nodiscard]] CanCounters counters() const override;

  /// Bytes that have come in so far; wraps. Whether it grows tells a line that is busy from one at rest.
  [[nodiscard]] std::uint32_t bytes_received() const { return in_.written(); }

 private:
  Uart uart_{kUart1};
  ByteRing<kReceiveBytes> in_;
  ByteRing<kTransmitBytes> out_;
  static constexpr std::uint32_t kNoArrival = UINT32_MAX;

  std::atomic<std::uint32_t> lost_bytes_{0};           ///< the interrupt's
  std::atomic<std::uint32_t> arrival_us_{kNoArrival};  ///< the interrupt's, taken by control
  SlcanWatch watch_{0};
  const Clock* clock_ = nullptr;  ///< null: nothing is watched for
  SlcanParser parser_;
  CanState state_ = CanState::kDown;
  CanCounters counters_;
};

}  // namespace s4tp::hal::mps
