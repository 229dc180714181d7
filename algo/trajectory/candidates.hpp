#pragma once
/// Motions worth considering (METHOD 4.1): target lane x longitudinal intent, each a quintic to the lane
/// centre. A candidate is kept as its recipe (about 100 bytes) and rolled out to a trajectory where it is
/// needed.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/scene/scene.hpp"

namespace s4tp {

enum class Intent : std::uint8_t {
  kAccelerate = 0,  ///< one of the fixed accelerations, speed kept in [0, limit]
  kStop = 1,        ///< stop before `stop_s_m`
  kFollow = 2,      ///< settle behind the leader of the target lane
  kPrevious = 3,    ///< the running plan, shifted
};

/// Lateral motion d(t) = sum c[i] t^i for t < duration, d_end afterwards; along: acceleration profile to a
/// target. All relative to `path` of the scene's ego_paths.
struct Candidate {
  std::uint8_t path = 0;  ///< index into Scene::ego_paths
  Intent intent = Intent::kAccelerate;
  float acceleration_mps2 = 0.0F;  ///< kAccelerate
  float stop_s_m = 0.0F;           ///< kStop: where the rear axle comes to rest
  float lateral[6] = {};           ///< quintic coefficients
  float lateral_duration_s = 0.0F;
  float lateral_end_m = 0.0F;
  float start_s_m = 0.0F;  ///< at plan start
  float start_speed_mps = 0.0F;
  float start_acceleration_mps2 = 0.0F;
};

/// Why a candidate was dropped; kNone: it was not.
enum class Rejection : std::uint8_t {
  kNone = 0,
  kInfeasible = 1,  ///< curvature, lateral acceleration, steering angle or rate
  kCollision = 2,   ///< predicted overlap
  kTerminal = 3,    ///< the end is not safe for ever
  kLeftOut = 4,     ///< more feasible ones than fit
};

using CandidateList = BoundedVector<Candidate, kMaxCandidates>;

/// The state the next plan starts from (METHOD: the state predicted for the next boundary).
/// The running plan's own state there when we are within 0.5 m sideways, 1 m along and 1 m/s of it, so that
/// commands are continuous; else the measured state brought forward.
[[nodiscard]] TrajectoryPoint plan_start(const EgoState& ego, std::uint32_t now_ms, const Plan& running,
                                         std::uint32_t start_ms, const Parameters& parameters);

/// All feasible candidates from `start`, at most kMaxCandidates: diversity over (path, intent) first, then
/// progress. \param left_out  receives how many feasible ones did not fit
void generate_candidates(const Scene& scene, const TrajectoryPoint& start, const Plan& running,
                         std::uint32_t start_ms, const Parameters& parameters, CandidateList& candidates,
                         int& left_out);

/// Rolls a candidate out. For kPrevious `running` is shifted and continued at constant acceleration to rest
/// or the limit.
void roll_out(const Scene& scene, const Candidate& candidate, const TrajectoryPoint& start,
              const Plan& running, std::uint32_t start_ms, const Parameters& parameters,
              Trajectory& trajectory);

}  // namespace s4tp
