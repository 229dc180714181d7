#pragma once
/// Drives one vehicle along one of its ways over the horizon.

#include "algo/satp/ego_motion.hpp"
#include "algo/satp/prediction.hpp"
#include "algo/satp/way.hpp"

namespace s4tp {

/// Progress along a way; s_m[i] is at (i + 1) * kStepS after plan start.
struct WayMotion {
  float s_m[kHorizonSteps];
  float end_mps = 0.0F;
};

/// A place to wait at (of the vehicle's centre), until when [s after plan start]; until <= 0: none.
struct Hold {
  float s_m = 0.0F;
  float until_s = 0.0F;
};

/// Car-following along the way. \param ego  us on its path  \param hold  on top of the way's own
void drive(const Way& way, const Track& track, const EgoOnPath& ego, const Hold& hold, WayMotion& motion);

/// Acceleration the driver would have now if we were not there [m/s^2].
[[nodiscard]] float undisturbed_acceleration(const Way& way, const Track& track);

/// When the motion passes arc length `goal_s_m` [s after plan start]; beyond the horizon at its last speed.
[[nodiscard]] float time_at(const Way& way, const WayMotion& motion, float goal_s_m);

/// Poses of the box centre along the motion: it returns to the lane centre within 1.2 s of driving, 2.8 s
/// from the next lane.
void place(const LaneMap& map, const LanePath& path, const Frenet& start, const Track& track,
           const WayMotion& motion, Mode& mode);

}  // namespace s4tp
