#pragma once
/// What an ECU process tells of itself through shared memory, record by record. Both ends are built from this
/// file; a reader built from another one is refused by the fingerprint.

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "algo/core/versions.hpp"
#include "algo/planner/probe.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"
#include "firmware/ecu/cycle.hpp"
#include "firmware/ecu/records.hpp"
#include "hal/linux/shared_records.hpp"

namespace s4tp::telemetry {

/// To be raised when a record changes its meaning and not its size.
inline constexpr std::uint32_t kRecordsVersion = 1;
/// The name where nobody gives another one.
inline constexpr const char* kDefaultName = "/s4tp_ecu";

/// One planning cycle: what the planner saw, expected and weighed. From the planning context.
struct CycleRecord {
  scene::Scene scene;  ///< its `map` is null: the map stands beside it
  LaneMap map;
  satp::PredictionSet prediction;  ///< for the plan chosen
  bool has_map = false;
  bool has_candidates = false;  ///< the following are of this cycle
  TrajectoryPoint start;
  Plan running;
  trajectory::ReferenceLines lines;
  trajectory::CandidateList candidates;
  planner::CostBreakdown costs[kMaxCandidates];
  std::uint32_t stage_ns[planner::kStageCount] = {};  ///< host time of each stage
};

/// How the ECU and its bus fare. From the control context, ten times a second.
struct StatusRecord {
  std::uint32_t time_ms = 0;  ///< vehicle time
  ecu::CycleStatistics cycles;
  std::uint32_t accepted_frames = 0;
  std::uint32_t rejected_frames = 0;
  hal::CanCounters bus;
  hal::CanState bus_state = hal::CanState::kActive;
};

/// Which ECU this is. Once, at its start.
struct IdentityRecord {
  char planner[32] = {};
  char bus[96] = {};
  Parameters parameters;
};

enum Stream : std::uint8_t { kPlan = 0, kCycle, kControl, kStatus, kIdentity, kModeChanges, kStreamCount };

/// A plan is told a boundary after its cycle, so more than the newest cycle is kept.
inline constexpr hal::linux_host::StreamSpec kStreams[kStreamCount] = {
    {sizeof(ecu::PlanRecord), hal::linux_host::kStateSlots},
    {sizeof(CycleRecord), 5},
    {sizeof(ecu::ControlRecord), hal::linux_host::kStateSlots},
    {sizeof(StatusRecord), hal::linux_host::kStateSlots},
    {sizeof(IdentityRecord), hal::linux_host::kStateSlots},
    {sizeof(ecu::ModeRecord), 64},
};

static_assert(std::is_trivially_copyable_v<CycleRecord> && std::is_trivially_copyable_v<ecu::PlanRecord> &&
              std::is_trivially_copyable_v<ecu::ControlRecord> &&
              std::is_trivially_copyable_v<IdentityRecord>);

/// TELE-001 Of versions and of the sizes of all that is in a record.
constexpr std::uint32_t fingerprint() {
  std::uint32_t hash = 2166136261U;  // FNV-1a
  for (const std::size_t part : {std::size_t{kRecordsVersion},
                                 std::size_t{kApiVersion},
                                 std::size_t{kParametersVersion},
                                 sizeof(void*),
                                 sizeof(scene::Scene),
                                 sizeof(scene::Agent),
                                 sizeof(scene::EgoPath),
                                 sizeof(LaneMap),
                                 sizeof(Lane),
                                 sizeof(Conflict),
                                 sizeof(satp::Mode),
                                 sizeof(satp::PredictionSet),
                                 sizeof(trajectory::Candidate),
                                 sizeof(trajectory::ReferenceLine),
                                 sizeof(planner::CostBreakdown),
                                 sizeof(planner::Explanation),
                                 sizeof(planner::BlockingReason),
                                 sizeof(sadrf::RiskProfile),
                                 sizeof(Plan),
                                 sizeof(Parameters),
                                 sizeof(ecu::PlanRecord),
                                 sizeof(ecu::ControlRecord),
                                 sizeof(ecu::ModeRecord),
                                 sizeof(StatusRecord),
                                 offsetof(CycleRecord, map),
                                 offsetof(CycleRecord, start),
                                 offsetof(CycleRecord, stage_ns)}) {
    hash = (hash ^ static_cast<std::uint32_t>(part)) * 16777619U;
  }
  return hash;
}

inline constexpr hal::linux_host::SharedLayout kLayout{kStreams, kStreamCount, fingerprint()};

}  // namespace s4tp::telemetry
