#pragma once
/// What the planner thought during an episode, for pictures and checks. Coordinates are the odometry frame's.

#include <cstdint>
#include <vector>

#include "algo/planner/planner.hpp"
#include "algo/planner/probe.hpp"
#include "firmware/ecu/records.hpp"
#include "hal/telemetry.hpp"

namespace s4tp::campaign {

/// The ECU's mode, and the faults that took it out of the planner's hands.
struct EcuState {
  ecu::Mode mode = ecu::Mode::kStandby;
  ecu::Faults stopped_for = 0;  ///< as it began to stop, or refused to drive; kept while it does

  void change(const ecu::ModeRecord& record);
};

/// One planning cycle.
struct CycleTrace {
  ecu::PlanRecord record;
  EcuState ecu;               ///< when the plan took effect
  std::vector<Track> tracks;  ///< as the scene saw them
  std::vector<satp::AgentPrediction> predictions;
  sadrf::RiskProfile risk;
};

/// Collects telemetry records and the probe's views of one ECU.
class Trace final : public hal::Telemetry, public planner::Probe {
 public:
  bool publish(std::uint16_t kind, const void* record, std::uint32_t size) override;
  void stage_begin(planner::Stage) override {}
  void stage_end(planner::Stage) override {}
  void cycle_done(const scene::Scene& scene, const satp::PredictionSet& prediction,
                  const sadrf::RiskProfile& risk) override;

  std::vector<CycleTrace> cycles;
  std::vector<ecu::ControlRecord> controls;
  std::vector<ecu::ModeRecord> modes;

 private:
  CycleTrace pending_;
  EcuState ecu_;
};

}  // namespace s4tp::campaign
