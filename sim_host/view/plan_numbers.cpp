#include "sim_host/view/plan_numbers.hpp"

#include <algorithm>

#include "sim_host/view/html.hpp"
#include "sim_host/view/plan_words.hpp"

namespace s4tp::view {
namespace {

std::string candidate_text(const trajectory::Candidate& candidate, scene::Manoeuvre manoeuvre) {
  static constexpr const char* kIntents[] = {"accelerate", "stop", "follow", "previous plan"};
  const char* const intent = candidate.in_gap ? "beside a gap" : kIntents[static_cast<int>(candidate.intent)];
  return format("%s, %s, %.1f m/s2", name_of(manoeuvre), intent,
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
  std::string line = format("\n  blocked %s: %s, %.1f m wanted", where,
                            kCauses[static_cast<int>(verdict.cause)], blocking.way_m);
  if (blocking.track != kNobody)
    line += format(", track %d (%s)", blocking.track, vehicle_name(cycle, blocking.track).c_str());
  if (blocking.unseen()) line += ", somebody we are not told of";
  if (verdict.cause == safety::Cause::kZone)
    line += format(", there in %.1f s, we leave in %.1f s", verdict.from_s, verdict.needed_s);
  return line;
}

/// What was decided, and since when; nothing where nothing was.
std::string manoeuvre_text(const Plan& plan) {
  static constexpr const char* kChanges[] = {"", "prepared", "crossing", "finishing", "settling"};
  static constexpr const char* kRequired[] = {"", "approaching its last place", "waiting at its last place"};
  static constexpr const char* kClaims[] = {"", "claimed", "committed to", "cleared", "withdrawn from"};
  const ManoeuvreState& state = plan.manoeuvre;
  std::string words;
  const auto add = [&](const std::string& what, int age_ms) {
    words += format("%s%s for %.1f s", words.empty() ? "" : "; ", what.c_str(), 1e-3 * age_ms);
  };
  if (state.lane_change != LaneChange::kKeep)
    add(format("change to the %s %s", state.side > 0 ? "left" : "right",
               kChanges[static_cast<int>(state.lane_change)]),
        state.lane_change_ms);
  if (state.required_change != RequiredChange::kNone)
    add(std::string("required change ") + kRequired[static_cast<int>(state.required_change)],
        state.required_change_ms);
  if (state.zone_claim != ZoneClaim::kConsidered)
    add(std::string("zones ahead ") + kClaims[static_cast<int>(state.zone_claim)], state.zone_claim_ms);
  return words.empty() ? words : "\n  manoeuvre: " + words;
}

}  // namespace

const char* name_of(scene::Manoeuvre manoeuvre) {
  static constexpr const char* kNames[] = {"keep", "left", "right"};
  return kNames[static_cast<int>(manoeuvre)];
}

int rejected(const planner::Explanation& e, trajectory::Rejection why) {
  return static_cast<int>(
      std::count(e.rejections, e.rejections + std::min<int>(e.candidate_count, kMaxCandidates), why));
}

std::string in_numbers(const campaign::CycleTrace& cycle) {
  const planner::Explanation& e = cycle.record.explanation;
  std::string lines = format("  %.1f m/s", cycle.record.plan.trajectory.points[0].speed_mps);
  if (e.status != Status::kOk) {
    lines += format(", no plan: %s", status_name(e.status));
  } else {
    lines += "\n  chosen:    " + candidate_text(e.chosen, e.manoeuvre) + "; " + cost_text(e.chosen_cost);
    if (e.decisions > 1)
      lines += "\n  runner-up: " + candidate_text(e.runner_up, e.runner_up_manoeuvre) + "; " +
               cost_text(e.runner_up_cost);
  }
  lines += manoeuvre_text(cycle.record.plan);
  lines += format("\n  rejected of %d: %d infeasible, %d refused by the guard, %d left out (and %d not made)",
                  e.candidate_count, rejected(e, trajectory::Rejection::kInfeasible),
                  rejected(e, trajectory::Rejection::kRefused), rejected(e, trajectory::Rejection::kLeftOut),
                  e.left_out);
  lines += blocking_text(cycle, e.blocking, "in our lane") + blocking_text(cycle, e.beside, "beside");
  if (e.tracks_left_out + e.lanes_left_out > 0)
    lines += format("\n  not told of: %d vehicles, %d lanes", e.tracks_left_out, e.lanes_left_out);
  if (e.rests_on.probability > 0.0F)
    lines +=
        format("\n  rests on:  track %d (%s) %s, %.0f %%; predicted by the %s", e.dominating_track,
               vehicle_name(cycle, e.dominating_track).c_str(),
               e.rests_on.yields ? "letting us pass" : "not braking for us", 100.0 * e.rests_on.probability,
               e.learned ? format("network, trusted to %.0f %%", 100.0 * e.rests_on.trust).c_str()
                         : "kinematic model");
  if (e.dominating_track != kNobody)
    lines += format("\n  risk:      track %d (%s) at +%.1f s", e.dominating_track,
                    vehicle_name(cycle, e.dominating_track).c_str(), 0.1 * (e.dominating_step + 1));
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

}  // namespace s4tp::view
