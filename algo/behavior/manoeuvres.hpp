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

/// The state to be put out with a plan taken. \param in_force  that of the plan before \param now_ms  when the plan taken
/// takes effect \pre scene.map is there, and plan.path one of its ego paths
[[nodiscard]] ManoeuvreState advance(const ManoeuvreState& in_force, const PlanTaken& plan,
                                     const scene::Scene& scene, std::uint32_t now_ms,
                                     const Parameters& parameters);

}  // namespace s4tp::behavior
