#pragma once
/// Every SIZE of the core, in one place. Values a user may tune at run time stand in parameters.hpp.

namespace s4tp {

// Time grid (method.md: dt, T, T_h).
inline constexpr float kStepS = 0.1F;     ///< dt, step of every horizon and history [s]
inline constexpr int kStepMs = 100;       ///< the same in vehicle time [ms]; also the planning period
inline constexpr int kHorizonSteps = 30;  ///< T, future steps: 3 s
inline constexpr float kHorizonS = static_cast<float>(kHorizonSteps) * kStepS;
inline constexpr int kTrajectoryPoints =
    kHorizonSteps + 1;                      ///< index 0 is the start, index i is i * dt later
inline constexpr int kHistorySamples = 11;  ///< T_h past steps and the present one

// Who is seen, who is predicted.
inline constexpr int kMaxTracks = 16;  ///< tracks on the wire; all take part in every safety check
inline constexpr int kMaxAgents = 5;   ///< N, vehicles predicted with interaction
inline constexpr int kMaxModes = 3;    ///< K, futures per predicted vehicle

// Map.
inline constexpr int kMaxLanes = 64;       ///< lanes within the horizon; the index is the slot on the wire
inline constexpr int kMaxLanePoints = 12;  ///< centre line vertices of one lane; longer lanes arrive split
inline constexpr int kMaxSuccessors = 3;   ///< lanes that continue one lane
inline constexpr int kMaxConflicts = 128;  ///< pairs of lanes that cross or merge
inline constexpr int kMaxPathLanes = 10;   ///< lanes strung together into one lane path
inline constexpr int kPathsPerAgent = 3;   ///< lane paths a vehicle may take
inline constexpr int kMaxPathZones = 12;   ///< conflict zones along one lane path

// Planning.
inline constexpr int kMaxCandidates = 24;                ///< candidates scored in one cycle
inline constexpr int kMaxDecisions = 3;                  ///< decisions predicted with our plan in mind
inline constexpr int kMaxExactRisk = kMaxDecisions + 1;  ///< exact risks: one each, and of the best refined

// Memory budget of the whole planner object [bytes] (docs/budget.md).
inline constexpr int kPlannerBudgetBytes = 64 * 1024;

}  // namespace s4tp
