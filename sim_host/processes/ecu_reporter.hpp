#pragma once
/// What an ECU process tells on the terminal. The control context only notes it, in fixed memory and without
/// waiting; whoever has time prints it.

#include <ostream>
#include <string>

#include "firmware/ecu/event_ring.hpp"
#include "firmware/ecu/records.hpp"
#include "hal/linux/linux_can.hpp"
#include "hal/telemetry.hpp"

namespace s4tp::processes {

class EcuReporter final : public hal::Telemetry {
 public:
  /// Control context: mode changes are noted, plans counted.
  bool publish(std::uint16_t kind, const void* record, std::uint32_t size) override;
  /// Control context: what became of the link.
  void note_news(hal::linux_host::LinkNews news);

  /// The other context: all that was noted since.
  void print(std::ostream& out, const std::string& bus);
  /// Control context, or after it has ended.
  [[nodiscard]] int plans() const { return plans_; }

 private:
  ecu::EventRing<ecu::ModeRecord, 64> modes_;
  ecu::EventRing<hal::linux_host::LinkNews, 16> news_;
  int plans_ = 0;
};

}  // namespace s4tp::processes
