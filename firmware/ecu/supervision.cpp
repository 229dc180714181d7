#include "firmware/ecu/supervision.hpp"

namespace s4tp::ecu {
namespace {

/// A fault that is there from `limit` on.
struct Limit {
  FaultBit fault;
  std::uint32_t Observations::*observed;
  std::uint32_t limit;
};

constexpr Limit kLimits[] = {
    {FaultBit::kMotionMissing, &Observations::motion_missing_ticks, 3},
    {FaultBit::kMotionTiming, &Observations::motion_mistimed_ticks, 3},
    {FaultBit::kPoseMissing, &Observations::pose_age_ms, 100},
    {FaultBit::kSteeringMissing, &Observations::steering_age_ms, 100},
    {FaultBit::kTracksStale, &Observations::tracks_age_ms, 250},
    {FaultBit::kTracksLost, &Observations::tracks_age_ms, 1000},
    {FaultBit::kMapStale, &Observations::map_age_ms, 1000},
    {FaultBit::kMapLost, &Observations::map_age_ms, 5000},
    {FaultBit::kPlanLost, &Observations::plan_age_ms, 500},
};

struct Flag {
  FaultBit fault;
  bool Observations::*observed;
};

constexpr Flag kFlags[] = {
    {FaultBit::kVersionMismatch, &Observations::version_mismatch},
    {FaultBit::kPlanLate, &Observations::plan_late},
    {FaultBit::kSelfTest, &Observations::refused},
    {FaultBit::kGateDenied, &Observations::gate_denied},
    {FaultBit::kDriverOverride, &Observations::driver_override},
};

constexpr float kTrackingLimitM = 1.5F;

}  // namespace

Faults find_faults(const Observations& observed) {
  Faults faults = observed.implausible;
  for (const Limit& row : kLimits) {
    if (observed.*row.observed >= row.limit) faults |= bit(row.fault);
  }
  for (const Flag& row : kFlags) {
    if (observed.*row.observed) faults |= bit(row.fault);
  }
  if (observed.bus == hal::CanState::kBusOff || observed.bus == hal::CanState::kDown) {
    faults |= bit(FaultBit::kBusOff);
  }
  if (observed.plan_distance_m > kTrackingLimitM) faults |= bit(FaultBit::kTracking);
  return faults;
}

}  // namespace s4tp::ecu
