#pragma once
/// All manoeuvres of a plan, moved on together. BEHAV-001 The state is that of the plan in force: it is moved on once, when
/// a plan is taken, by the rows of the tables and nothing else; what was only proposed, or refused, changes nothing.
/// BEHAV-002 A lane change is begun, dropped, given up, finished and settled as lane_change.hpp says; its target is told by
/// its state, not by where a plan ends. BEHAV-003 A group of zones is committed to exactly while the fail-safe in force passes
/// it; a claim is withdrawn when the plan stays out, or after 3 s. A lateral offset is no decision: it is found anew.

#include "algo/behavior/lane_change.hpp"
#include "algo/behavior/required_change.hpp"
#include "algo/behavior/zone_claim.hpp"

namespace s4tp::behavior {

inline constexpr int kAdvanceWork = 25;  ///< of advance() [WorkMeter's units]

/// Everything has been as it is for so much longer; no time has passed where that is below 0.
void pass_time(std::int32_t elapsed_ms, ManoeuvreState& state);

/// Moves the state of the plan in force on to what is put out with the plan taken.
/// \pre scene.map is there, and plan.path one of its ego paths
void advance(const PlanTaken& plan, const scene::Scene& scene, const Parameters& parameters,
             ManoeuvreState& state);

}  // namespace s4tp::behavior
