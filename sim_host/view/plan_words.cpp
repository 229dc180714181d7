#include "sim_host/view/plan_words.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/inline.hpp"
#include "sim_host/view/html.hpp"

namespace s4tp::view {
namespace {

constexpr int kNobody = 255;
constexpr int kUnseen = -2;  // has no track
constexpr float kRestMps = 0.3F;
constexpr float kNoticeableMps = 0.7F;  // within the horizon
constexpr float kNoticeableM = 2.0F;    // as much further the rejected motion must have gone
constexpr float kFollowingS = 2.5F;     // farther ahead nobody is followed
constexpr float kBendMps2 = 1.5F;
constexpr float kSoonS = 60.0F;          // later arrivals have no number
constexpr std::size_t kBriefCycles = 3;  // shorter reason_spans are passed over

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

const Track* find_track(const campaign::CycleTrace& cycle, int id) {
  for (const Track& track : cycle.tracks) {
    if (track.id == id) return &track;
  }
  return nullptr;
}

const char* kind_of(const Track& track) {
  if (track.length_m >= 9.0F) return "truck";
  if (track.length_m >= 6.0F) return "van";
  return track.width_m < 1.2F ? "motorcycle" : "car";
}

/// "the car from the left", seen from where the plan starts.
std::string name_of(const campaign::CycleTrace& cycle, int id) {
  if (id == kUnseen) return "somebody we are not told of";
  const Track* const track = find_track(cycle, id);
  if (track == nullptr) return "somebody";
  const Pose& ours = start_of(cycle).rear_axle;
  const Point local = to_local(ours, position(track->centre));
  const float turned = wrap_angle(track->centre.heading_rad - ours.heading_rad);
  const std::string kind =
      std::string(track->speed_mps < kRestMps ? "the standing " : "the ") + kind_of(*track);
  const char* const side = local.y_m > 0.0F ? "left" : "right";
  if (std::abs(turned) > 0.75F * kPi) return "the oncoming " + std::string(kind_of(*track));
  if (std::abs(turned) > 0.25F * kPi) return kind + " from the " + (turned < 0.0F ? "left" : "right");
  const bool beside_lane = std::abs(local.y_m) > 1.8F;
  const float front_m = local.x_m + 0.5F * track->length_m;
  const float rear_m = local.x_m - 0.5F * track->length_m;
  if (front_m > -1.0F && rear_m < 4.0F && beside_lane) return kind + " beside us on the " + side;
  const char* const where = local.x_m > 0.0F ? " ahead" : " behind";
  return kind + where + (beside_lane ? std::string(" on the ") + side : std::string());
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

Reason about(Doing doing, const planner::BlockingReason& blocking) {
  if (blocking.unseen()) return {doing, because_of(blocking.verdict), kUnseen};
  return about(doing, because_of(blocking.verdict), blocking.track);
}

/// What a drive under way is about.
Reason driving_reason(const campaign::CycleTrace& cycle, Doing doing) {
  const planner::Explanation& e = cycle.record.explanation;
  const bool slow = doing == Doing::kWaiting || doing == Doing::kHalting || doing == Doing::kSlower ||
                    doing == Doing::kDriving;
  if (!slow) return about(doing, Because::kNothing);
  const bool held =
      !e.blocking.verdict.safe() && e.blocking.way_m > way_m(cycle.record.plan.trajectory) + kNoticeableM;
  const bool near =
      e.leader_track != kNobody && e.leader_gap_m < 8.0F + kFollowingS * start_of(cycle).speed_mps;
  if (held) {
    return about(doing, e.blocking);
  }
  if (near && (doing != Doing::kDriving || e.chosen.intent == trajectory::Intent::kFollow))
    return about(doing, Because::kLeader, e.leader_track);
  if (risk_decided(e)) return about(doing, Because::kRisk, e.dominating_track);
  if (doing == Doing::kSlower && lateral_mps2(cycle.record.plan.trajectory) > kBendMps2)
    return about(doing, Because::kBend);
  return about(doing, Because::kNothing);
}

const char* doing_words(Doing doing) {
  switch (doing) {
    case Doing::kWaiting:
      return "Waiting";
    case Doing::kSettingOff:
      return "Setting off";
    case Doing::kDriving:
      return "Driving on";
    case Doing::kFaster:
      return "Speeding up";
    case Doing::kSlower:
      return "Slowing down";
    case Doing::kHalting:
      return "Coming to a halt";
    case Doing::kLeft:
      return "Changing to the left lane";
    case Doing::kRight:
      return "Changing to the right lane";
    case Doing::kStopping:
      return "Stopping to be safe";
  }
  return "?";
}

std::string giving_way(const std::string& who, const safety::Verdict& verdict) {
  if (verdict.from_s <= 0.0F) return who + " is in our way";
  if (verdict.from_s > kSoonS) return who + " has to pass first";
  return format("%s can be there in %.1f s, we would need %.1f s", who.c_str(), verdict.from_s,
                verdict.needed_s);
}

/// The half sentence behind the colon; empty when there is nothing to say.
std::string because_words(const campaign::CycleTrace& cycle, const Reason& reason,
                          const safety::Verdict& verdict) {
  const planner::Explanation& e = cycle.record.explanation;
  const bool unseen = reason.track == kUnseen;
  const std::string who = name_of(cycle, reason.track < 0 && !unseen ? kNobody : reason.track);
  switch (reason.because) {
    case Because::kNothing:
      return "";
    case Because::kLeader:
      if (unseen) return who + " may stand ahead";
      return reason.track == e.leader_track
                 ? format("%s is %.0f m away", who.c_str(), std::max(e.leader_gap_m, 0.0F))
                 : who + " leaves no more room";
    case Because::kGivingWay:
      return giving_way(who, verdict);
    case Because::kNoRoom:
      return "beyond the junction there is no room, and it must not be blocked";
    case Because::kRoadEnd:
      return "our lane ends ahead";
    case Because::kBehind:
      return who + " would have to brake hard for us";
    case Because::kRisk:
      return "going on faster would feel risky because of " + who;
    case Because::kBend:
      return "a bend";
    case Because::kNoLane:
      return "no lane can be seen under us";
    case Because::kNoSafeWay:
      return "no way on is safe enough";
    case Because::kBadInput:
      return "what the sensors say cannot be right";
    case Because::kNobodySeen:
      return "the sensors have not said for too long who is around";
  }
  return "";
}

const char* manoeuvre_name(scene::Manoeuvre manoeuvre) {
  static constexpr const char* kNames[] = {"keep", "left", "right"};
  return kNames[static_cast<int>(manoeuvre)];
}

std::string candidate_text(const trajectory::Candidate& candidate, scene::Manoeuvre manoeuvre) {
  static constexpr const char* kIntents[] = {"accelerate", "stop", "follow", "previous plan"};
  const char* const intent = candidate.in_gap ? "beside a gap" : kIntents[static_cast<int>(candidate.intent)];
  return format("%s, %s, %.1f m/s2", manoeuvre_name(manoeuvre), intent,
                static_cast<double>(candidate.acceleration_mps2));
}

std::string cost_text(const planner::CostBreakdown& cost) {
  return format("cost %.1f = progress %.1f + speed %.1f + jerk %.2f + lateral %.2f + lane %.1f + risk %.1f",
                cost.total(), cost.progress, cost.speed, cost.jerk, cost.lateral, cost.lane, cost.risk);
}

std::string blocking_text(const campaign::CycleTrace& cycle, const planner::BlockingReason& blocking,
                          const char* where) {
  static constexpr const char* kCauses[] = {
      "", "no path", "road's end", "leader", "follower", "zone", "would stand in the zone"};
  const safety::Verdict& verdict = blocking.verdict;
  if (verdict.safe()) return "";
  std::string line = format("\n  held up %s: %s, %.1f m wanted", where,
                            kCauses[static_cast<int>(verdict.cause)], blocking.way_m);
  if (blocking.track != kNobody)
    line += format(", track %d (%s)", blocking.track, name_of(cycle, blocking.track).c_str());
  if (blocking.unseen()) line += ", somebody we are not told of";
  if (verdict.cause == safety::Cause::kZone)
    line += format(", there in %.1f s, we leave in %.1f s", verdict.from_s, verdict.needed_s);
  return line;
}

double since_entry_s(const campaign::CycleTrace& cycle, double pre_roll_s) {
  return cycle.record.plan.start_ms / 1000.0 - pre_roll_s;
}

int rejected(const planner::Explanation& e, trajectory::Rejection why) {
  return static_cast<int>(
      std::count(e.rejections, e.rejections + std::min<int>(e.candidate_count, kMaxCandidates), why));
}

}  // namespace

Reason reason_of(const campaign::CycleTrace& cycle) {
  const Doing doing = doing_of(cycle);
  switch (cycle.record.explanation.status) {
    case Status::kOk:
      return driving_reason(cycle, doing);
    case Status::kNoLane:
      return about(doing, Because::kNoLane);
    case Status::kNoSafePlan:
      return {doing, Because::kNoSafeWay, about(doing, cycle.record.explanation.blocking).track};
    case Status::kStaleTracks:
      return about(doing, Because::kNobodySeen);
    default:
      return about(doing, Because::kBadInput);
  }
}

std::string in_words(const campaign::CycleTrace& cycle) {
  const planner::Explanation& e = cycle.record.explanation;
  const Reason reason = reason_of(cycle);
  std::string words = doing_words(reason.doing);
  const std::string because = because_words(cycle, reason, e.blocking.verdict);
  if (!because.empty()) words += ": " + because;
  // The check's word on the way that was wanted most.
  if (reason.because == Because::kNoSafeWay && !e.blocking.verdict.safe()) {
    Reason wanted = reason;
    wanted.because = because_of(e.blocking.verdict);
    words += "; " + because_words(cycle, wanted, e.blocking.verdict);
  }
  words += ".";
  // Behind somebody slower a passenger wonders why he is not passed.
  const bool follows = reason.because == Because::kLeader && reason.doing == Doing::kDriving;
  if (follows && !e.beside.verdict.safe() && (e.beside.track != kNobody || e.beside.unseen()) &&
      e.beside.way_m > way_m(cycle.record.plan.trajectory) + kNoticeableM) {
    words += std::string(" No change to the ") + manoeuvre_name(e.beside.manoeuvre) + ": " +
             because_words(cycle, about(reason.doing, e.beside), e.beside.verdict) + ".";
  }
  return words;
}

std::string vehicle_name(const campaign::CycleTrace& cycle, int track) {
  return name_of(cycle, track);
}

std::string in_numbers(const campaign::CycleTrace& cycle) {
  const planner::Explanation& e = cycle.record.explanation;
  std::string lines = format("  %s, %.1f m/s", status_name(e.status), start_of(cycle).speed_mps);
  if (e.status == Status::kOk) {
    lines += "\n  chosen:    " + candidate_text(e.chosen, e.manoeuvre) + "; " + cost_text(e.chosen_cost);
    if (e.decisions > 1)
      lines += "\n  runner-up: " + candidate_text(e.runner_up, e.runner_up_manoeuvre) + "; " +
               cost_text(e.runner_up_cost);
  }
  lines += format("\n  rejected of %d: %d infeasible, %d refused by the guard, %d left out (and %d not made)",
                  e.candidate_count, rejected(e, trajectory::Rejection::kInfeasible),
                  rejected(e, trajectory::Rejection::kRefused), rejected(e, trajectory::Rejection::kLeftOut),
                  e.left_out);
  lines += blocking_text(cycle, e.blocking, "in our lane") + blocking_text(cycle, e.beside, "beside");
  if (e.tracks_left_out + e.lanes_left_out > 0)
    lines += format("\n  not told of: %d vehicles, %d lanes", e.tracks_left_out, e.lanes_left_out);
  if (e.dominating_track != kNobody)
    lines += format("\n  risk:      track %d (%s) at +%.1f s", e.dominating_track,
                    name_of(cycle, e.dominating_track).c_str(), 0.1 * (e.dominating_step + 1));
  if (std::any_of(std::begin(e.risk.obstacle), std::end(e.risk.obstacle), [](float r) { return r > 0.0F; })) {
    lines += "\n  R_obs every 0.5 s:";
    for (int i = 4; i < kHorizonSteps; i += 5) lines += format(" %.0f", e.risk.obstacle[i]);
  }
  static constexpr const char* kStages[] = {"scene",      "candidates", "predict", "rank",
                                            "exact risk", "optimize",   "check",   "explain"};
  lines += "\n  work:     ";
  for (int i = 0; i < planner::kStageCount; ++i) lines += format(" %s %d", kStages[i], e.work[i]);
  return lines;
}

std::vector<ReasonSpan> reason_spans(const campaign::Trace& trace, double pre_roll_s) {
  struct Run {
    Reason reason;
    std::size_t first;
    std::size_t cycles;
  };
  std::vector<Run> runs;  // one a change
  for (std::size_t i = 0; i < trace.cycles.size(); ++i) {
    if (since_entry_s(trace.cycles[i], pre_roll_s) < 0.0) continue;  // nobody drives yet
    const Reason reason = reason_of(trace.cycles[i]);
    if (runs.empty() || runs.back().reason != reason) runs.push_back({reason, i, 0});
    ++runs.back().cycles;
  }
  std::vector<Run> joined;
  for (const Run& run : runs) {
    const bool brief = run.cycles < kBriefCycles && run.reason.doing != Doing::kStopping;
    if (!joined.empty() && (brief || joined.back().reason == run.reason)) {
      joined.back().cycles += run.cycles;
    } else {
      joined.push_back(run);
    }
  }
  std::vector<ReasonSpan> result;
  for (const Run& run : joined) {
    const campaign::CycleTrace& cycle = trace.cycles[run.first];
    const double from_s = since_entry_s(cycle, pre_roll_s);
    result.push_back(
        {from_s, from_s + 0.1 * static_cast<double>(run.cycles), in_words(cycle), in_numbers(cycle)});
  }
  return result;
}

void print_reason_spans(std::ostream& out, const campaign::Trace& trace, double pre_roll_s) {
  for (const ReasonSpan& passage : reason_spans(trace, pre_roll_s)) {
    out << format("%6.1f .. %5.1f s  ", passage.from_s, passage.to_s) << passage.words << '\n'
        << passage.numbers << "\n\n";
  }
}

}  // namespace s4tp::view
