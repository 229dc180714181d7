#pragma once
/// An ECU at its end of an in-process bus, with the planner of a name make_ecu() knows.

#include <memory>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "algo/planner/probe.hpp"
#include "firmware/wire/frame.hpp"
#include "hal/can.hpp"
#include "hal/flash_bank.hpp"
#include "hal/telemetry.hpp"
#include "sim_host/baselines/any_ecu.hpp"

namespace s4tp::campaign {

class Driver {
 public:
  virtual ~Driver() = default;
  /// One control tick in lock-step: frames of the world in (TICK last), frames of the ECU out. A planning
  /// cycle that becomes due runs before the call returns.
  virtual void tick(const std::vector<wire::Frame>& from_world, std::vector<wire::Frame>& to_world) = 0;
  /// The plan being made now will miss its boundary.
  virtual void inject_deadline_miss() = 0;
  /// What the ECU believes of the world, and its mode.
  [[nodiscard]] virtual const ecu::EcuCore& core() const = 0;
  /// The ECU's end of the bus.
  [[nodiscard]] virtual const hal::Can& bus() const = 0;
};

/// \param telemetry  may be null \param weights  ecu::Ports::weights \throws as make_ecu()
[[nodiscard]] std::unique_ptr<Driver> make_driver(const std::string& planner, bool guarded,
                                                  const Parameters& parameters, hal::Telemetry* telemetry,
                                                  planner::Probe* probe,
                                                  const hal::FlashBank* weights = nullptr);

}  // namespace s4tp::campaign
