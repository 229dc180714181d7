#pragma once
/// What the network sees of a scene, of our plan, and what it is trained against (docs/satp.md).
///
/// All in SI units; every vehicle in its own frame: x ahead, y left of its anchor, the place of its box
/// centre at plan start when it keeps speed and heading. What is missing is 0 and masked; no value is ever a
/// mask.
///
/// \code
///   scene time        plan start = time zero                    + 3 s
///     car ---lead---> anchor ==predicted poses, every 0.1 s====>
/// \endcode

#include <cstdint>

#include "algo/core/config.hpp"
#include "algo/core/geometry.hpp"

namespace s4tp::satp {

inline constexpr int kLanePoints = 17;        ///< of a lane path, from the vehicle's foot point on
inline constexpr float kLaneSpacingM = 3.0F;  ///< between them
inline constexpr int kDecoderSteps = 6;       ///< GRU steps of the horizon
inline constexpr int kStepsPerDecode = kHorizonSteps / kDecoderSteps;  ///< pose increments a GRU step emits
static_assert(kStepsPerDecode * kDecoderSteps == kHorizonSteps, "GRU steps span the horizon");

inline constexpr int kHistoryFeatures = 5;  ///< x, y, heading, v_x, v_y
inline constexpr int kPlaceFeatures = 8;    ///< x, y, sin, cos of the heading, v_x, v_y, length, width
/// x, y, heading, speed limit; 0 or 1: here it yields to us, has priority, first come; a stop line is next
inline constexpr int kLaneFeatures = 8;
/// our box centre at the step's begin: x, y, heading; at its end: the same; speed at the end; our way left to
/// the first shared zone's entry and exit at the end
inline constexpr int kPlanValues = 9;

/// Columns of NetworkInput::pair: how one vehicle and we stand to each other.
enum class PairFeature : std::uint8_t {
  kZone,             ///< 0 or 1: our paths share a zone
  kEntryM,           ///< of the first one, along its path from the vehicle's anchor
  kExitM,            ///<
  kOurEntryM,        ///< along our path from our anchor
  kOurExitM,         ///<
  kYields,           ///< 0 or 1: it has to give way there
  kFirstCome,        ///< 0 or 1
  kHasPriority,      ///< 0 or 1
  kMerging,          ///< 0 or 1: both paths go on in one lane
  kStoodS,           ///< how long it has stood, at most 20 s
  kWeStoodS,         ///< how long we have stood at the junction, at most 20 s
  kLengthM,          ///<
  kWidthM,           ///<
  kLeader,           ///< 0 or 1: it follows another vehicle on its likeliest path
  kLeaderGapM,       ///< bumper to bumper, at most 100 m
  kLeaderMps,        ///< the leader's speed
  kWeAhead,          ///< 0 or 1: we are ahead on its path
  kAheadGapM,        ///< bumper to bumper, -20 .. 100 m
  kWeBehind,         ///< 0 or 1: it is ahead on one of our paths
  kBehindGapM,       ///<
  kSpeedMps,         ///< its
  kOurSpeedMps,      ///<
  kAcceleration,     ///< its [m/s^2]
  kOurAcceleration,  ///<
  kYawRateRadps,     ///< its
  kOurXM,            ///< our anchor in its frame
  kOurYM,            ///<
  kOurSin,           ///<
  kOurCos,           ///<
  kLikeliest,        ///< probability of its first path
  kSecond,           ///< of its second path
  kHoldS,            ///< how long others with priority keep it waiting on its likeliest path
  kCount
};
inline constexpr int kPairFeatures = static_cast<int>(PairFeature::kCount);

struct NetworkInput {
  int hdvs = 0;     ///< vehicles there; Scene::watched
  Pose ego_anchor;  ///< local odometry frame, as `anchor`: for targets and results only
  Pose anchor[kMaxAgents];
  float speed_mps[kMaxAgents] = {};     ///< of the constant-velocity base
  std::uint16_t ego_history_valid = 0;  ///< bit j: sample j is there, oldest first
  std::uint16_t history_valid[kMaxAgents] = {};
  float ego_history[kHistorySamples][kHistoryFeatures] = {};
  float history[kMaxAgents][kHistorySamples][kHistoryFeatures] = {};
  float place[1 + kMaxAgents][kPlaceFeatures] = {};           ///< in our frame; row 0 is ours
  std::uint8_t lane_points[kMaxAgents][kPathsPerAgent] = {};  ///< points there, from the first on
  /// 0 or 1: a path it may take and one of ours have a lane or a zone in common, or one of us is on no lane.
  /// Where they have not, no plan of ours enters what is expected of it.
  std::uint8_t paths_meet[kMaxAgents] = {};
  float lane[kMaxAgents][kPathsPerAgent][kLanePoints][kLaneFeatures] = {};
  float pair[kMaxAgents][kPairFeatures] = {};
};

/// Our plan as the decoder reads it, per vehicle and GRU step, in the vehicle's frame.
struct PlanInput {
  float step[kMaxAgents][kDecoderSteps][kPlanValues] = {};
};

/// What the vehicles did: x, y, heading in the own frame at (i + 1) * kStepS after plan start.
struct TargetPoses {
  float pose[kMaxAgents][kHorizonSteps][3] = {};
  std::uint32_t valid[kMaxAgents] = {};  ///< bit i: step i was seen
};

/// The network sees value / unit, within +-kInputRange. Units bring every column to about the same size, so
/// that one int8 scale serves a row of weights.
inline constexpr float kInputRange = 4.0F;
inline constexpr float kHistoryUnit[kHistoryFeatures] = {25.0F, 25.0F, 1.0F, 10.0F, 10.0F};
inline constexpr float kPlaceUnit[kPlaceFeatures] = {25.0F, 25.0F, 1.0F, 1.0F, 10.0F, 10.0F, 5.0F, 5.0F};
inline constexpr float kLaneUnit[kLaneFeatures] = {25.0F, 25.0F, 1.0F, 10.0F, 1.0F, 1.0F, 1.0F, 1.0F};
inline constexpr float kPairUnit[kPairFeatures] = {
    1.0F, 25.0F, 25.0F, 25.0F, 25.0F, 1.0F,  1.0F, 1.0F, 1.0F, 10.0F, 10.0F, 5.0F, 5.0F, 1.0F, 25.0F, 10.0F,
    1.0F, 25.0F, 1.0F,  25.0F, 10.0F, 10.0F, 3.0F, 3.0F, 0.5F, 25.0F, 25.0F, 1.0F, 1.0F, 1.0F, 1.0F,  3.0F};

inline constexpr int kOwnFeatures = 8;    ///< x, y, sin, cos of the heading, v_x, v_y, v0, time
inline constexpr int kPlanFeatures = 12;  ///< step_features.hpp
inline constexpr float kOwnUnit[kOwnFeatures] = {25.0F, 25.0F, 1.0F, 1.0F, 10.0F, 10.0F, 10.0F, 3.0F};
inline constexpr float kPlanUnit[kPlanFeatures] = {25.0F, 25.0F, 25.0F, 25.0F, 1.0F, 1.0F,
                                                   10.0F, 25.0F, 25.0F, 1.0F,  1.0F, 1.0F};
/// Of the decoder's outputs: dx, dy [m] and dpsi [rad] a step of kStepS.
inline constexpr float kIncrementUnit[3] = {0.2F, 0.05F, 0.02F};

}  // namespace s4tp::satp
