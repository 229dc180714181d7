#pragma once
/// Plain records the ECU hands to telemetry.

#include <cstdint>

#include "algo/core/trajectory.hpp"
#include "algo/planner/explanation.hpp"
#include "firmware/ecu/modes.hpp"
#include "firmware/gate/command_gate.hpp"

namespace s4tp::ecu {

enum class RecordKind : std::uint16_t { kPlan = 1, kControl = 2, kModeChange = 3 };

/// At each boundary at which a plan takes effect.
struct PlanRecord {
  std::uint32_t computed_ms = 0;  ///< vehicle time of the snapshot it was made from
  Plan plan;
  planner::Explanation explanation;
  std::uint32_t digest = 0;
};

/// At each control tick.
struct ControlRecord {
  std::uint32_t time_ms = 0;
  Mode mode = Mode::kStandby;
  Faults faults = 0;
  gate::Command asked;
  gate::Command sent;
  gate::Violations violations = 0;
  float cross_track_m = 0.0F;  ///< of the rear axle from the plan's point of this instant; left positive
  float along_track_m = 0.0F;  ///< ahead positive
};

struct ModeRecord {
  std::uint32_t time_ms = 0;
  Mode from = Mode::kStandby;
  Mode to = Mode::kStandby;
  TransitionId reason = TransitionId::kNone;
  Faults faults = 0;
};

}  // namespace s4tp::ecu
