#pragma once
/// The frames the ECU sends, each with its own protection.

#include <cstdint>

#include "algo/planner/explanation.hpp"
#include "algo/satp/weight_image.hpp"
#include "firmware/ecu/cycle.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/gate/command_gate.hpp"
#include "firmware/wire/e2e.hpp"
#include "hal/can.hpp"

namespace s4tp::ecu {

struct StatusReport {
  Mode mode = Mode::kStandby;
  Faults faults = 0;
  Status planner = Status::kNotInitialized;
  PlanKind plan_kind = PlanKind::kNone;
  std::uint32_t plan_age_ms = 0;
  std::uint32_t deadline_misses = 0;  ///< low 8 bits are sent
  std::uint32_t rejected_frames = 0;  ///< low 8 bits are sent
};

/// A frame that does not go out (queue full, bus off) is counted by the CAN port; the next one is on its way.
class Reporter {
 public:
  /// ECU-065 Each tick, as its last frame; echoes the low 12 bits of the tick's number and of the count of
  /// frames taken.
  void command(hal::Can& can, const gate::Command& command, Mode mode, std::uint32_t tick,
               std::uint32_t accepted);
  void status(hal::Can& can, const StatusReport& report);         ///< ECU-066 every 100 ms
  void statistics(hal::Can& can, const CycleStatistics& cycles);  ///< ECU-067 every 1000 ms
  /// ECU-068 Every 1000 ms. ECU-103 With whether the network's weights were taken, and why not.
  void version(hal::Can& can, satp::WeightStatus weights);
  /// ECU-069 When a plan takes effect: its digest, and why it was chosen. ECU-101 How many vehicles and lanes
  /// it was not told of (31: or more), and whether one of those is what keeps it from going further. ECU-104 And
  /// whether the network predicted, or the kinematic model in its place.
  void plan(hal::Can& can, std::uint32_t sequence, std::uint32_t digest,
            const planner::Explanation& explanation);

 private:
  wire::E2eSender command_;
  wire::E2eSender status_;
  wire::E2eSender statistics_;
  wire::E2eSender version_;
  wire::E2eSender digest_;
  wire::E2eSender reason_;
};

}  // namespace s4tp::ecu
