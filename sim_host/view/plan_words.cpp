#include "sim_host/view/plan_words.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/inline.hpp"
#include "sim_host/campaign/fault_names.hpp"
#include "sim_host/view/html.hpp"
#include "sim_host/view/plan_numbers.hpp"

namespace s4tp::view {
namespace {

constexpr float kRestMps = 0.3F;
constexpr float kSoonS = 60.0F;          // later arrivals have no number
constexpr std::size_t kBriefCycles = 3;  // shorter reason_spans are passed over

const TrajectoryPoint& start_of(const campaign::CycleTrace& cycle) {
  return cycle.record.plan.trajectory.points[0];
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
    case Doing::kStopped:
      return "Stopped to be safe";
    case Doing::kOutOfOrder:
      return "Out of order";
  }
  return "?";
}

bool moves_on(Doing doing) {
  return doing != Doing::kWaiting && doing != Doing::kHalting && doing < Doing::kStopping;
}

std::string fault_words(const campaign::EcuState& ecu) {
  const std::string found = "the ECU found a fault (" + campaign::fault_names(ecu.stopped_for) + ") and ";
  if (ecu.mode == ecu::Mode::kMinimumRisk) return found + "no longer follows the planner";
  return found + (ecu.mode == ecu::Mode::kStopped ? "stands until the driver takes over" : "cannot drive");
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
      return "going on faster would be risky because of " + who;
    case Because::kBend:
      return "a bend";
    case Because::kNoLane:
      return "no lane can be seen under us";
    case Because::kNoSafeWay:
      return "no way on is safe enough";
    case Because::kBadInput:
      return "what the sensors say cannot be right";
    case Because::kEcuFault:
      return fault_words(cycle.ecu);
    case Because::kNobodySeen:
      return "the sensors have not said for too long who is around";
  }
  return "";
}

double since_entry_s(const campaign::CycleTrace& cycle, double pre_roll_s) {
  return cycle.record.plan.start_ms / 1000.0 - pre_roll_s;
}

}  // namespace

std::string in_words(const campaign::CycleTrace& cycle) {
  const planner::Explanation& e = cycle.record.explanation;
  const Reason reason = reason_of(cycle);
  std::string words = doing_words(reason.doing);
  const std::string because = because_words(cycle, reason, e.blocking.verdict);
  if (!because.empty()) words += ": " + because;
  // The check's word on the way that was wanted most.
  if (reason.because == Because::kNoSafeWay && !e.blocking.verdict.safe()) {
    Reason wanted = reason;
    wanted.because = reason_of(reason.doing, e.blocking).because;
    words += "; " + because_words(cycle, wanted, e.blocking.verdict);
  }
  words += ".";
  // A plan that goes because somebody is expected to brake.
  if (e.status == Status::kOk && e.rests_on.yields && moves_on(reason.doing)) {
    words += format(" It counts on %s letting us pass (%.0f %%).", name_of(cycle, e.dominating_track).c_str(),
                    100.0 * e.rests_on.probability);
  }
  // Behind somebody slower a passenger wonders why the car does not pass.
  const bool follows = reason.because == Because::kLeader && reason.doing == Doing::kDriving;
  if (follows && (e.beside.track != kNobody || e.beside.unseen()) && wanted_further(cycle, e.beside)) {
    words += std::string(" No change to the ") + name_of(e.beside.manoeuvre) + ": " +
             because_words(cycle, reason_of(reason.doing, e.beside), e.beside.verdict) + ".";
  }
  return words;
}

std::string vehicle_name(const campaign::CycleTrace& cycle, int track) {
  return name_of(cycle, track);
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
    const bool brief =
        run.cycles < kBriefCycles && run.reason.doing < Doing::kStopping;  // a stop to be safe never is
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
