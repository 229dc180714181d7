#pragma once
/// An ECU with a planner in it, at its end of the bus. Planners are chosen by name.

#include <memory>
#include <string>
#include <vector>

#include "algo/core/parameters.hpp"
#include "algo/planner/probe.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/wire/frame.hpp"
#include "hal/telemetry.hpp"

namespace s4tp::campaign {

class Driver {
 public:
  virtual ~Driver() = default;
  /// One control tick in lock-step: frames of the world in (TICK last), frames of the ECU out. A planning
  /// cycle that becomes due runs before the call returns.
  virtual void tick(const std::vector<wire::Frame>& from_world, std::vector<wire::Frame>& to_world) = 0;
  /// The plan being made now will miss its boundary.
  virtual void inject_deadline_miss() = 0;
  [[nodiscard]] virtual ecu::Mode mode() const = 0;
};

/// Names make_driver() accepts: s4tp, constant_speed, blind.
[[nodiscard]] const std::vector<std::string>& planner_names();

/// \param telemetry  may be null  \param probe  may be null; only the s4tp planner has one
/// \throws std::invalid_argument naming the planners there are, or the first bad parameter
[[nodiscard]] std::unique_ptr<Driver> make_driver(const std::string& planner, const Parameters& parameters,
                                                  hal::Telemetry* telemetry, Probe* probe);

}  // namespace s4tp::campaign
