#pragma once
/// Last look at a trajectory before it becomes the plan (METHOD 4.6).

#include <cstdint>

#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/safety/terminal.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

enum class CheckResult : std::uint8_t {
  kPassed = 0,      ///< CHECK-001
  kNotFinite = 1,   ///< CHECK-002 a value is NaN or infinite
  kInfeasible = 2,  ///< CHECK-003 beyond the vehicle's limits
  kCollision = 3,   ///< CHECK-004 overlaps a predicted vehicle
  kTerminal = 4,    ///< CHECK-005 the end is not safe for ever
};

struct CheckReport {
  CheckResult result = CheckResult::kPassed;
  std::uint8_t agent = 255;  ///< whom it would hit, or who makes its end unsafe; 255: nobody
  std::uint8_t step = 0;     ///< when it would hit him
  TerminalCause terminal = TerminalCause::kNone;
  float arrives_s = 0.0F;  ///< with TerminalCause::kZone: TerminalVerdict's
  float needed_s = 0.0F;
  bool hard = false;
};

/// Finite, feasible, no collision with the modes without plan, the conditioned modes, and "keeps doing what
/// it does" over the first 1.5 s; then the terminal condition. A future that does not yield is forgiven to a
/// vehicle that owes us the way, or is already braking to a stop before it, and can do so with 4 m/s^2
/// (CHECK-006); every future to one whom the terminal condition trusts to leave us a zone (CHECK-009), but
/// not that it stays where it stands in our way, over all 3 s (CHECK-011). Being hit from behind by who
/// follows us in the lane we are in is no reason to reject (CHECK-007), nor by who can stay behind us in the
/// lane that a change under way leads into (CHECK-010, lane_change.hpp). `ego_path` as in judge_terminal.
[[nodiscard]] CheckReport check_trajectory(const Scene& scene, int ego_path, const Trajectory& trajectory,
                                           const PredictionSet& unconditioned,
                                           const PredictionSet& conditioned, const KinematicSet& keep_going,
                                           const Parameters& parameters);

/// The same for a trajectory known to be feasible already. \param sight  along `ego_path`, from its start
[[nodiscard]] CheckReport check_feasible(const Scene& scene, int ego_path, const PathSight& sight,
                                         const Trajectory& trajectory, const PredictionSet& unconditioned,
                                         const PredictionSet& conditioned, const KinematicSet& keep_going,
                                         const Parameters& parameters);

/// First step whose boxes are nearer than `margin_m`, or -1. Who is nearer than that from the first step on
/// counts when the gap has halved, or, touching already, when it is 0.3 m deeper: standing close is not a
/// collision (CHECK-008).
[[nodiscard]] int first_collision(const Trajectory& trajectory, const Mode& mode, const Track& track,
                                  int steps, float margin_m, const Parameters& parameters);

}  // namespace s4tp
