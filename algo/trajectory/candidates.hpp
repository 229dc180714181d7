#pragma once
/// Motions worth considering (method.md 4.5): target lane x longitudinal intent. Where we go and how fast are
/// kept apart: a quintic d(s) to the lane centre, and a speed profile along it. So a car at rest has a pose,
/// a heading and a curvature (CAND-005), and a plan that is re-timed stays on its path. A candidate is kept
/// as its recipe and rolled out to a trajectory where it is needed.

#include <cstdint>

#include "algo/core/bounded.hpp"
#include "algo/core/parameters.hpp"
#include "algo/core/trajectory.hpp"
#include "algo/core/work_meter.hpp"
#include "algo/scene/scene.hpp"
#include "algo/trajectory/along_path.hpp"
#include "algo/trajectory/reference_line.hpp"

namespace s4tp::trajectory {

enum class Intent : std::uint8_t {
  kAccelerate = 0,  ///< one of the fixed accelerations, speed kept in [0, limit]
  kStop = 1,        ///< stop before `stop_s_m`
  kFollow = 2,      ///< settle behind the leader of the target lane
  kPrevious = 3,    ///< the running plan, shifted
};

/// A gap of a lane beside (lane_gap.hpp), as a place that moves on.
struct MergeTarget {
  std::uint8_t path = 0;  ///< of that lane; 0, the keep path: there is none
  float s_m = 0.0F;       ///< of the rear axle along the keep path, at plan start
  float speed_mps = 0.0F;
};

/// Relative to the smoothed centre line (reference_line.hpp) of `path` of the scene's ego_paths; s is that of
/// our rear axle. Speed never exceeds [0, limit and curves ahead] on purpose: a start above is braked down.
struct Candidate {
  std::uint8_t path = 0;  ///< index into Scene::ego_paths
  Intent intent = Intent::kAccelerate;
  float acceleration_mps2 = 0.0F;  ///< kAccelerate: held after a bounded jerk; else: at most this
  float target_s_m = 0.0F;         ///< kStop: where the rear axle comes to rest, not beyond (CAND-006);
                                   ///< kFollow: where it would touch the leader, or in_gap, at plan start
  float target_speed_mps = 0.0F;   ///< kFollow: the leader's or the gap's, held
  float lateral[6] = {};          ///< d = sum lateral[i] u^i, u = (s - start_s) / length in [0, 1], then d(1)
  float lateral_length_m = 1.0F;  ///< > 0
  bool steered = false;           ///< no quintic fits: steered back to the line (steering.hpp)
  bool in_gap = false;     ///< kFollow: settles at a gap's place, or beside it in our own lane (CAND-015)
  float start_s_m = 0.0F;  ///< at plan start
};

/// Why a candidate was dropped; kNone: it was not.
enum class Rejection : std::uint8_t {
  kNone = 0,
  kInfeasible = 1,  ///< curvature, lateral acceleration, steering angle or rate
  kRefused = 3,     ///< the guard knows no fail-safe from it
  kLeftOut = 4,     ///< more feasible ones than fit
};

using CandidateList = BoundedVector<Candidate, kMaxCandidates>;

/// One line for each of Scene::ego_paths, in their order.

/// Whether `time_ms` lies within the plan's validity. False for a plan of kind none.
[[nodiscard]] bool plan_covers(const Plan& plan, std::uint32_t time_ms);

/// The state the next plan starts from (the state predicted for the next boundary).
/// The running plan's own state there when we are within 0.5 m sideways, 1 m along, 0.15 rad and 1 m/s of it,
/// so that commands are continuous (CAND-007); else the measured state brought forward (CAND-008).
[[nodiscard]] TrajectoryPoint plan_start(const EgoState& ego, std::uint32_t now_ms, const Plan& running,
                                         std::uint32_t start_ms, const Parameters& parameters);

/// Who looks at each candidate as soon as it is kept, while its roll-out is at hand.
class CandidateVisitor {
 public:
  /// \param trajectory  what candidates are rolled out into
  explicit CandidateVisitor(Trajectory& trajectory) : rolled_out(trajectory) {}
  /// `rolled_out` is the roll-out of candidate `index` of the list, its last one so far. The running plan
  /// comes first.
  virtual void visit(int index) = 0;
  Trajectory& rolled_out;
  int roll_outs = 0;                                             ///< so far
  WorkMeter meter{kUnboundedWork};                               ///< what the candidates themselves may take
  Leader leaders[decltype(scene::Scene::ego_paths)::kCapacity];  ///< along each path

 protected:
  ~CandidateVisitor() = default;
};

/// CAND-021 Roll-outs of a cycle, a steered one counting as three; what is not tried then is left out.
inline constexpr int kMaxRollOuts = 60;

/// Of the strongest drive, and of the lateral acceleration that makes a plan infeasible: some is left to follow the plan with.
inline constexpr float kDriveShare = 0.85F;

inline constexpr int kRollOutWork = 215;  ///< of one [WorkMeter's units], and ...
inline constexpr int kSteeredWork = 430;  ///< ... of a steered one

/// Feasible candidates from `start`, at most `most` and kMaxCandidates (CAND-009): diversity over (path,
/// intent) first, then progress; two that move alike count once. The keep path's hard braking and stops are
/// always among those tried first, while `visitor.meter` lasts. To go on with the running plan's manoeuvre, and to stay in our
/// own lane, come before all else.
/// \param lines  of the scene's paths (driven_lines.hpp), which the candidates are rolled out on
/// \param left_out  receives how many feasible ones did not fit, and how many `most` left untried \param aim  adds
/// a candidate that settles there, and one beside it in our own lane, behind our own leader (CAND-015)
void generate_candidates(const scene::Scene& scene, const TrajectoryPoint& start, const Plan& running,
                         std::uint32_t start_ms, const Parameters& parameters, int most,
                         const ReferenceLines& lines, CandidateList& candidates, int& left_out,
                         CandidateVisitor& visitor, const MergeTarget& aim = {});
/// The same without a visitor.
void generate_candidates(const scene::Scene& scene, const TrajectoryPoint& start, const Plan& running,
                         std::uint32_t start_ms, const Parameters& parameters, int most,
                         const ReferenceLines& lines, CandidateList& candidates, int& left_out,
                         const MergeTarget& aim = {});

/// Rolls a candidate out on the line of its path. points[0] is `start` itself; speeds >= 0; each point lies
/// where its speed leads (CAND-010). For kPrevious `running` is shifted and continued along the path at its
/// last acceleration, to rest or the limit; while its end is more than 0.3 m off the line, its last second is
/// steered there anew, so that it is not carried across (CAND-016).
void roll_out(const ReferenceLine& line, const Candidate& candidate, const TrajectoryPoint& start,
              const Plan& running, std::uint32_t start_ms, const Parameters& parameters,
              Trajectory& trajectory);

}  // namespace s4tp::trajectory
