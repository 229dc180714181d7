#pragma once
/// The fail-safe (method.md 4.9): what is driven when no new plan has passed. Part of every plan: the plan
/// itself up to `branch_s`, then braking along its path to a standstill. The guard has shown that it meets
/// nobody who keeps to the law.
///
/// \code
///   stop    plan --|branch: the next plan, and one missed boundary|-- brakes to a standstill
///   clear   plan ------------------------|branch: the zones are left|-- brakes to a standstill
/// \endcode

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"

namespace s4tp::safety {

/// The fail-safe of the plan in force, from `start` on: FAIL-001 its first part up to the branch, then
/// `braking_mps2` at least, and as hard as the plan braked there; beside the plan its path is driven in
/// parallel. FAIL-002 Without a plan that covers `start_ms`, or headed so differently that this path is none of
/// a vehicle's (keeps_limits()), braking with the present steering. FAIL-003 Every value is finite, after the
/// branch the speed grows only while the acceleration of before is taken back, at rest the pose stays.
/// \param plan  receives the trajectory and what is left of the fail-safe; kind kMinimumRisk
/// \pre plan is not running
void drive_fail_safe(const Plan& running, const TrajectoryPoint& start, std::uint32_t start_ms,
                     float braking_mps2, const Parameters& parameters, Plan& plan);

}  // namespace s4tp::safety
