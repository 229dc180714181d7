#pragma once
/// Our own motion over the horizon: the output side of the core.

#include <cstdint>

#include "algo/core/config.hpp"
#include "algo/core/geometry.hpp"
#include "algo/core/manoeuvre.hpp"

namespace s4tp {

/// One instant of our own planned motion; the reference point is the rear axle.
struct TrajectoryPoint {
  Pose rear_axle;
  float speed_mps = 0.0F;  ///< >= 0
  float acceleration_mps2 = 0.0F;
  float curvature_1pm =
      0.0F;  ///< of the rear axle's path, left positive; steering = atan(wheelbase * curvature)
};

/// points[i] holds at start + i * kStepS.
struct Trajectory {
  TrajectoryPoint points[kTrajectoryPoints];
};

/// What a plan is, for whoever follows it.
enum class PlanKind : std::uint8_t { kNone = 0, kDrive = 1, kMinimumRisk = 2 };

/// How a plan is given up when no new one takes effect: driven until `branch_s` after its start, then braked
/// to a standstill along its own path.
struct FailSafe {
  float branch_s = 0.0F;  ///< >= 0; 0: at once
  float braking_mps2 = 0.0F;
};

/// A trajectory with the instant it takes effect. Valid for kHorizonSteps * kStepS from there.
struct Plan {
  PlanKind kind = PlanKind::kNone;
  std::uint32_t start_ms = 0;  ///< vehicle time of points[0]
  Trajectory trajectory;
  FailSafe fail_safe;
  ManoeuvreState manoeuvre;  ///< what was decided
};

/// The state a `share` of the way from `a` to `b`; headings along the shorter way. \pre 0 <= share <= 1
[[nodiscard]] TrajectoryPoint interpolate(const TrajectoryPoint& a, const TrajectoryPoint& b, float share);

/// State of a plan at `time_ms`, interpolated; before the start the first point, after the end the last one.
[[nodiscard]] TrajectoryPoint sample(const Plan& plan, std::uint32_t time_ms);

}  // namespace s4tp
