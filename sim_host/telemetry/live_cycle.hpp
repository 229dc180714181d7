#pragma once
/// What the live view shows, as JSON: a message a planning cycle, whole in itself. Lengths in m, in the
/// odometry frame; lines are x, y, x, y ..

#include <nlohmann/json.hpp>
#include <string>

#include "sim_host/telemetry/derive.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// Who matters most for what we do, in words.
struct WhoMatters {
  int track = -1;          ///< -1: nobody
  bool holds_up = false;   ///< it is why we wait, brake or follow; else it is only watched
  std::string name;        ///< "the oncoming car"
  std::string belief;      ///< how likely it lets us go first; empty where that is no question
  std::string claim;       ///< what it may claim, or leaves to us; empty where ways do not meet
};

/// VIEW-010 Of whom a reason names, it; else who may come first where ways meet, else whose risk is largest.
[[nodiscard]] WhoMatters who_matters(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                     const std::vector<GroundClaim>& claims);

/// VIEW-011 Mode, faults, deadlines, bus.
[[nodiscard]] nlohmann::ordered_json ecu_json(const IdentityRecord& identity,
                                              const ecu::ControlRecord& control, const StatusRecord& status);

/// VIEW-012 Scene, futures, candidates by cost, plan and fail-safe, reasons, costs of stages.
/// \param risk  the picture of it, or null: none was computed
[[nodiscard]] nlohmann::ordered_json cycle_json(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                                const Parameters& parameters, const HeatMap* risk);

}  // namespace s4tp::telemetry
