#pragma once
/// What can be worked out again from a cycle's record, away from the ECU: the planner's own functions on the
/// planner's own values.

#include <vector>

#include "algo/core/trajectory.hpp"
#include "algo/sadrf/heat_map.hpp"
#include "algo/safety/legal_occupancy.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

struct RolledOut {
  Trajectory trajectory;
  trajectory::Rejection rejection = trajectory::Rejection::kNone;
  planner::CostBreakdown cost;
  bool costed = false;  ///< it was not rejected
  bool chosen = false;  ///< the plan began as this one
};

/// TELE-010 All candidates of the cycle, in their order; none when the cycle had none.
[[nodiscard]] std::vector<RolledOut> candidates_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                                   const Parameters& parameters);

/// What the candidates that were not rejected cost; zeros when there are none.
struct CostRange {
  float least = 0.0F;
  float most = 0.0F;
};
[[nodiscard]] CostRange cost_range(const std::vector<RolledOut>& candidates);

/// TELE-011 The risk around us, as s4tp::heat_row draws it. Takes tens of milliseconds.
[[nodiscard]] sadrf::HeatMap heat_map_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                         const Parameters& parameters);

/// TELE-012 The plan's fail-safe: what is driven if no further plan takes effect.
[[nodiscard]] Plan fail_safe_of(const ecu::PlanRecord& plan, const Parameters& parameters);

/// What a vehicle may claim on ground that it shares with us.
struct GroundClaim {
  safety::ZoneOccupancy its;
  float we_leave_s = occupancy::kNeverS;  ///< after plan start; so large: the plan waits
};

/// Of two claims the one to reckon with: one that may come before one that stays out, then the
/// one that can be there first.
[[nodiscard]] bool matters_more(const safety::ZoneOccupancy& one, const safety::ZoneOccupancy& other);

/// TELE-013 What each vehicle of the scene may claim where its way meets the one we chose, in the scene's
/// order: of its zones the one it may be in first. No claim where ways do not meet.
[[nodiscard]] std::vector<GroundClaim> claims_of(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                                 const Parameters& parameters);

/// TELE-014 What each vehicle of the scene adds to the plan's risk, in the scene's order: the risk, both
/// sides, there would be with it alone, over the sum of these; zeros where there is none.
[[nodiscard]] std::vector<float> risk_shares(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                             const Parameters& parameters);

}  // namespace s4tp::telemetry
