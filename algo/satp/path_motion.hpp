#pragma once
/// Drives one vehicle along one of its hypotheses over the horizon.

#include "algo/satp/ego_motion.hpp"
#include "algo/satp/path_hypothesis.hpp"
#include "algo/satp/prediction.hpp"

namespace s4tp::satp {

/// Progress along a hypothesis; s_m[i] is at (i + 1) * kStepS after plan start.
struct PathMotion {
  float s_m[kHorizonSteps];
  float end_mps = 0.0F;
};

/// A place to wait at (of the vehicle's centre), until when [s after plan start]; until <= 0: none.
struct Hold {
  float s_m = 0.0F;
  float until_s = 0.0F;
};

/// Car-following along the hypothesis. \param ego  us on its path  \param hold  on top of the hypothesis' own
void drive(const PathHypothesis& hypothesis, const Track& track, const EgoOnPath& ego, const Hold& hold,
           PathMotion& motion);

/// Acceleration the driver would have now if we were not there [m/s^2].
[[nodiscard]] float undisturbed_acceleration(const PathHypothesis& hypothesis, const Track& track);

/// When the motion passes arc length `goal_s_m` [s after plan start]; beyond the horizon at its last speed.
[[nodiscard]] float time_at(const PathHypothesis& hypothesis, const PathMotion& motion, float goal_s_m);

/// Poses of the box centre along the motion: it returns to the lane centre within 1.2 s of driving, 2.8 s
/// from the next lane.
void place(const LaneMap& map, const scene::LanePath& path, const scene::Frenet& start, const Track& track,
           const PathMotion& motion, Mode& mode);

}  // namespace s4tp::satp
