#include "sim_host/telemetry/who_matters.hpp"

#include <cmath>

#include "sim_host/telemetry/watch.hpp"
#include "sim_host/view/html.hpp"
#include "sim_host/view/plan_words.hpp"

namespace s4tp::telemetry {
namespace {

const satp::AgentPrediction* futures_of(const CycleRecord& cycle, int agent) {
  for (const satp::AgentPrediction& one : cycle.prediction.agents) {
    if (one.agent == agent) return &one;
  }
  return nullptr;
}

int agent_of(const CycleRecord& cycle, int track) {
  for (int i = 0; i < cycle.scene.agents.size(); ++i) {
    if (cycle.scene.agents[i].track.id == track) return i;
  }
  return -1;
}

/// What to look at when nobody blocks us.
int most_relevant(const ecu::PlanRecord& plan, const CycleRecord& cycle,
                  const std::vector<GroundClaim>& claims) {
  safety::ZoneOccupancy first;
  int agent = -1;
  for (int i = 0; i < cycle.scene.agents.size(); ++i) {
    const safety::ZoneOccupancy& one = claims[static_cast<std::size_t>(i)].its;
    if (!matters_more(one, first)) continue;
    first = one;
    agent = i;
  }
  return agent >= 0 ? agent : agent_of(cycle, plan.explanation.dominating_track);
}

}  // namespace

long percent(float part) {
  return std::lround(100.0F * part);
}

long gives_way(const CycleRecord& cycle, int agent, const GroundClaim& claim) {
  const satp::AgentPrediction* const futures = futures_of(cycle, agent);
  if (futures == nullptr) return -1;
  float part = 0.0F;
  for (const satp::Mode& mode : futures->modes)
    part += 0.01F * static_cast<float>(mode.yields_percent) * mode.probability;
  return claim.its.claim == safety::Claim::kNone && part <= 0.0F ? -1 : percent(part);
}

std::string claim_words(const GroundClaim& claim) {
  switch (claim.its.claim) {
    case safety::Claim::kNone:
      return "";
    case safety::Claim::kMayCome:
      if (claim.its.from_s <= 0.0F) return "is where our ways meet";
      return view::format("need not wait for us: it can be there in %.1f s", claim.its.from_s) +
             (claim.we_leave_s < claim.its.from_s
                  ? view::format("; we are out of its way in %.1f s", claim.we_leave_s)
                  : "");
    case safety::Claim::kOwes:
      return "owes us the way: it has to stop for us";
    case safety::Claim::kCanStop:
      return "has priority, but can still stop gently: it leaves us the way";
    case safety::Claim::kStands:
      return "has priority, but stands and has seen us stand: it leaves us the way";
  }
  return "";
}

WhoMatters who_matters(const campaign::CycleTrace& trace, const CycleRecord& cycle,
                       const std::vector<GroundClaim>& claims) {
  const ecu::PlanRecord& plan = trace.record;
  const view::Reason reason = view::reason_of(trace);
  WhoMatters who;
  int agent = agent_of(cycle, reason.track);
  who.blocks = agent >= 0;
  if (agent < 0) agent = most_relevant(plan, cycle, claims);
  if (agent < 0) return who;
  GroundClaim claim = claims[static_cast<std::size_t>(agent)];
  who.track = cycle.scene.agents[agent].track.id;
  who.name = view::vehicle_name(trace, who.track);
  const safety::Verdict& verdict = plan.explanation.blocking.verdict;
  const bool waits_for_it = who.blocks && reason.because == view::Because::kGivingWay &&
                            verdict.needed_s > 0.0F && claim.its.claim == safety::Claim::kMayCome;
  // Of the motion that was wanted most, as the words have it.
  if (waits_for_it) claim = {{.claim = safety::Claim::kMayCome, .from_s = verdict.from_s}};
  who.claim = claim_words(claim);
  if (waits_for_it) who.claim += view::format("; we would need until %.1f s", verdict.needed_s);
  if (const long belief = gives_way(cycle, agent, claim); belief >= 0)
    who.belief = view::format("lets us go first with a probability of %ld\u00a0%%", belief);
  return who;
}

}  // namespace s4tp::telemetry
