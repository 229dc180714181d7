#pragma once
/// Why the car does what it does: the struct every plan carries (algo/planner/explanation.hpp), boiled down to one reason.

#include "sim_host/campaign/trace.hpp"

namespace s4tp::view {

/// What the car is about to do with a plan.
enum class Doing {
  kWaiting,
  kSettingOff,
  kDriving,
  kFaster,
  kSlower,
  kHalting,
  kLeft,
  kRight,
  kStopping,
  kStopped,
  kOutOfOrder
};

/// What it does that for.
enum class Because {
  kNothing,    ///< the road is free
  kLeader,     ///< who drives ahead
  kGivingWay,  ///< somebody may be where our ways cross
  kNoRoom,     ///< we would have to stand where ways cross
  kRoadEnd,    ///< the road or lane ends
  kBehind,     ///< who comes from behind in the other lane
  kRisk,       ///< the faster way was riskier
  kBend,
  kNoLane,
  kNoSafeWay,
  kBadInput,
  kNobodySeen,
  kEcuFault,  ///< the ECU stops, or has stopped, without the planner: what it plans is not driven
};

inline constexpr int kNobody = 255;  ///< no track, in a plan's explanation
inline constexpr int kUnseen = -2;   ///< somebody without a track

/// Why, without its numbers: plans with the same reason are one passage.
struct Reason {
  Doing doing = Doing::kDriving;
  Because because = Because::kNothing;
  int track = -1;  ///< id of who it is about; -1: nobody, kUnseen: somebody we are not told of
  friend bool operator==(const Reason&, const Reason&) = default;
};
[[nodiscard]] Reason reason_of(const campaign::CycleTrace& cycle);

/// Why the guard refused a motion, while the car does what it does instead.
[[nodiscard]] Reason reason_of(Doing doing, const planner::BlockingReason& refused);
/// Whether a motion was refused that would have gone further than the plan.
[[nodiscard]] bool wanted_further(const campaign::CycleTrace& cycle, const planner::BlockingReason& refused);

}  // namespace s4tp::view
