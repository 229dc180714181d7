#pragma once
/// One fault script: the world and an ECU on one bus, with the script's faults between them and the judge
/// beside.

#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "firmware/ecu/ecu_core.hpp"
#include "firmware/wire/codec.hpp"
#include "firmware/wire/frame.hpp"
#include "sim_host/faults/judge.hpp"
#include "sim_host/faults/script.hpp"
#include "sim_host/world/nodes/vehicle_node.hpp"
#include "sim_host/world/scenario/scenario.hpp"
#include "sim_host/world/traffic/recording.hpp"

namespace s4tp::faults {

using Scenarios = std::map<std::string, scenario::Scenario>;

struct RunResult {
  Verdict verdict;
  traffic::Ending ending = traffic::Ending::kRunning;  ///< kRunning: the time was over
  bool own_fault = false;                              ///< a collision attributed to our car
  unsigned modes = 0;                                  ///< bit m: mode m was reached
};

struct RunOptions {
  /// A planted defect: sees what the ECU took in a control tick and may change what it sends.
  std::function<void(const std::vector<wire::Frame>& taken, std::vector<wire::Frame>& sent)> defect;
  /// Each tick, after the ECU's. \param pose  newest one that was sent, before any fault
  std::function<void(int tick, const ecu::EcuCore& ecu, const wire::Pose& pose)> watch;
  nodes::SensorOptions sensors = {};  ///< errors of the car's sensors
  std::ostream* story = nullptr;      ///< mode changes, with their time and faults
};

/// Ends at the first breach, the world's end, or kRunTicks after entry.
/// \throws std::out_of_range when `scenarios` has none of the script's name
[[nodiscard]] RunResult run_script(const Scenarios& scenarios, const FaultScript& script,
                                   const RunOptions& options = {});

}  // namespace s4tp::faults
