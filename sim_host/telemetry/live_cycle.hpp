#pragma once
/// What the live view shows, as JSON: a message a planning cycle, whole in itself. Lengths in m, in the
/// odometry frame; lines are x, y, x, y ..

#include <nlohmann/json.hpp>
#include <string>

#include "sim_host/campaign/trace.hpp"
#include "sim_host/telemetry/derive.hpp"
#include "sim_host/telemetry/records.hpp"

namespace s4tp::telemetry {

/// VIEW-011 Mode, faults, deadlines, bus.
[[nodiscard]] nlohmann::ordered_json ecu_json(const IdentityRecord& identity,
                                              const ecu::ControlRecord& control, const StatusRecord& status);

/// VIEW-012 Scene, futures, candidates by cost, plan and fail-safe, reasons, costs of stages.
/// \param risk  the picture of it, or null: none was computed
[[nodiscard]] nlohmann::ordered_json cycle_json(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                                                const campaign::EcuState& ecu, const Parameters& parameters,
                                                const sadrf::HeatMap* risk);

}  // namespace s4tp::telemetry
