#include "sim_host/view/plan_words.hpp"

#include <cmath>

#include "sim_host/view/html.hpp"

namespace s4tp::view {
namespace {

constexpr float kStandingMps = 0.3F;
constexpr float kSameSpeedMps = 0.8F;

std::string motion(const Trajectory& plan) {
  const float now_mps = plan.points[0].speed_mps;
  const float end_mps = plan.points[kHorizonSteps].speed_mps;
  const double end_kmh = 3.6 * static_cast<double>(end_mps);
  if (now_mps < kStandingMps && end_mps < kStandingMps) return "Standing";
  if (end_mps < kStandingMps) return "Stopping";
  if (now_mps < kStandingMps) return "Starting off";
  if (std::abs(end_mps - now_mps) < kSameSpeedMps) return format("Keeping about %.0f km/h", end_kmh);
  return format("%s to %.0f km/h", end_mps > now_mps ? "Speeding up" : "Slowing down", end_kmh);
}

/// Why not further or faster; empty: nothing stands against it.
std::string hindrance(const CheckReport& report) {
  switch (report.result) {
    case CheckResult::kPassed:
      return {};
    case CheckResult::kNotFinite:
      return "the way further could not be computed";
    case CheckResult::kInfeasible:
      return "more than the car can do";
    case CheckResult::kCollision:
      return "going further would touch another car";
    case CheckResult::kTerminal:
      break;
  }
  switch (report.terminal) {
    case TerminalCause::kNoPath:
      return "no way is known ahead";
    case TerminalCause::kRoadEnd:
      return "the road ends ahead";
    case TerminalCause::kLaneEnd:
      return "the lane has to be left first";
    case TerminalCause::kStopsInZone:
      return "there is no room to leave the crossing again";
    case TerminalCause::kZone:
      return "somebody may be in the crossing with us";
    case TerminalCause::kLeader:
      return "the car ahead may brake";
    case TerminalCause::kFollower:
      return "the car behind in the other lane would have to brake hard";
    case TerminalCause::kNone:
      break;
  }
  return {};
}

}  // namespace

std::string in_words(const campaign::CycleTrace& cycle) {
  const Explanation& explanation = cycle.record.explanation;
  const std::string doing = motion(cycle.record.plan.trajectory);
  if (cycle.record.plan.kind == PlanKind::kMinimumRisk) {
    return doing + ", at the least risk: " +
           (explanation.status == Status::kNoLane ? "no lane is known here." : "no plan passed every check.");
  }
  std::string text = doing;
  if (explanation.candidate_count > 0 && explanation.chosen.intent == Intent::kFollow) {
    text += ", behind the car ahead";
  }
  const std::string why = hindrance(explanation.held_up);
  if (!why.empty()) text += ": " + why;
  return text + (explanation.rss_clipped ? ". Braked to keep the safe distance." : ".");
}

}  // namespace s4tp::view
