#include "sim_host/view/plan_reason.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/inline.hpp"

namespace s4tp::view {
namespace {

constexpr float kRestMps = 0.3F;
constexpr float kNoticeableMps = 0.7F;  // within the horizon
constexpr float kNoticeableM = 2.0F;    // as much further the rejected motion must have gone
constexpr float kFollowingS = 2.5F;     // farther ahead nobody is followed
constexpr float kBendMps2 = 1.5F;

const TrajectoryPoint& start_of(const campaign::CycleTrace& cycle) {
  return cycle.record.plan.trajectory.points[0];
}

const TrajectoryPoint& end_of(const campaign::CycleTrace& cycle) {
  return cycle.record.plan.trajectory.points[kHorizonSteps];
}

float way_m(const Trajectory& trajectory) {
  float way = 0.0F;
  for (const TrajectoryPoint& point : trajectory.points) way += kStepS * point.speed_mps;
  return way;
}

Because because_of(const safety::Verdict& verdict) {
  switch (verdict.cause) {
    case safety::Cause::kNone:
      return Because::kNothing;
    case safety::Cause::kNoPath:
    case safety::Cause::kRoadEnd:
      return Because::kRoadEnd;
    case safety::Cause::kNoRoom:
      return Because::kNoRoom;
    case safety::Cause::kZone:
      return Because::kGivingWay;
    case safety::Cause::kLeader:
      return Because::kLeader;
    case safety::Cause::kFollower:
      return Because::kBehind;
  }
  return Because::kNothing;
}

Doing doing_of(const campaign::CycleTrace& cycle) {
  const float before = start_of(cycle).speed_mps;
  const float after = end_of(cycle).speed_mps;
  if (cycle.record.plan.kind == PlanKind::kMinimumRisk) return Doing::kStopping;
  if (before < kRestMps) return after < kNoticeableMps ? Doing::kWaiting : Doing::kSettingOff;
  if (cycle.record.explanation.manoeuvre == scene::Manoeuvre::kLeft) return Doing::kLeft;
  if (cycle.record.explanation.manoeuvre == scene::Manoeuvre::kRight) return Doing::kRight;
  if (after < kRestMps) return Doing::kHalting;
  if (after < before - kNoticeableMps) return Doing::kSlower;
  return after > before + kNoticeableMps ? Doing::kFaster : Doing::kDriving;
}

/// The sharpest turning of the plan.
float lateral_mps2(const Trajectory& trajectory) {
  float most = 0.0F;
  for (const TrajectoryPoint& point : trajectory.points)
    most = std::max(most, square(point.speed_mps) * std::abs(point.curvature_1pm));
  return most;
}

bool risk_decided(const planner::Explanation& e) {
  return e.dominating_track != kNobody && e.runner_up_cost.progress < e.chosen_cost.progress - 1.0F &&
         e.runner_up_cost.risk > e.chosen_cost.risk + 1.0F;
}

Reason about(Doing doing, Because because, int track = kNobody) {
  return {doing, because, track == kNobody ? -1 : track};
}

/// What a drive under way is about.
Reason driving_reason(const campaign::CycleTrace& cycle, Doing doing) {
  const planner::Explanation& e = cycle.record.explanation;
  const bool slow = doing == Doing::kWaiting || doing == Doing::kHalting || doing == Doing::kSlower ||
                    doing == Doing::kDriving;
  if (!slow) return about(doing, Because::kNothing);
  const bool near =
      e.leader_track != kNobody && e.leader_gap_m < 8.0F + kFollowingS * start_of(cycle).speed_mps;
  if (wanted_further(cycle, e.blocking)) return reason_of(doing, e.blocking);
  if (near && (doing != Doing::kDriving || e.chosen.intent == trajectory::Intent::kFollow))
    return about(doing, Because::kLeader, e.leader_track);
  if (risk_decided(e)) return about(doing, Because::kRisk, e.dominating_track);
  if (doing == Doing::kSlower && lateral_mps2(cycle.record.plan.trajectory) > kBendMps2)
    return about(doing, Because::kBend);
  return about(doing, Because::kNothing);
}

}  // namespace

Reason reason_of(Doing doing, const planner::BlockingReason& refused) {
  if (refused.unseen()) return {doing, because_of(refused.verdict), kUnseen};
  return about(doing, because_of(refused.verdict), refused.track);
}

bool wanted_further(const campaign::CycleTrace& cycle, const planner::BlockingReason& refused) {
  return !refused.verdict.safe() && refused.way_m > way_m(cycle.record.plan.trajectory) + kNoticeableM;
}

Reason reason_of(const campaign::CycleTrace& cycle) {
  switch (cycle.ecu.mode) {
    case ecu::Mode::kMinimumRisk:
      return about(Doing::kStopping, Because::kEcuFault);
    case ecu::Mode::kStopped:
      return about(Doing::kStopped, Because::kEcuFault);
    case ecu::Mode::kFault:
      return about(Doing::kOutOfOrder, Because::kEcuFault);
    default:
      break;
  }
  const Doing doing = doing_of(cycle);
  switch (cycle.record.explanation.status) {
    case Status::kOk:
      return driving_reason(cycle, doing);
    case Status::kNoLane:
      return about(doing, Because::kNoLane);
    case Status::kNoSafePlan:
      return {doing, Because::kNoSafeWay, reason_of(doing, cycle.record.explanation.blocking).track};
    case Status::kStaleTracks:
      return about(doing, Because::kNobodySeen);
    default:
      return about(doing, Because::kBadInput);
  }
}

}  // namespace s4tp::view
