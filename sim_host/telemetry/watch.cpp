#include "sim_host/telemetry/watch.hpp"

#include <algorithm>

namespace s4tp::telemetry {
namespace {
constexpr std::uint64_t kLooksPerCheck = 20;  // looking for the writer takes system calls
}

News Watch::look() {
  News news;
  if (memory_.is_open() && looks_++ % kLooksPerCheck == 0 && memory_.abandoned()) {
    memory_.close();
    absence_ = "the ECU has ended";
    news.ecu_gone = true;
  }
  if (!memory_.is_open()) attach(news);
  if (!memory_.is_open()) return news;
  (void)take(kIdentity, identity_);
  news.control = take(kControl, control_);
  news.status = take(kStatus, status_);
  news.plan = take(kPlan, plan_);
  if (news.plan) cycle_known_ = find_cycle();
  std::uint64_t overwritten = 0;  // the newest mode is known all the same
  for (ecu::ModeRecord change; memory_.next(kModeChanges, seen_[kModeChanges], overwritten, &change);)
    news.mode_changes.push_back(change);
  for (const ecu::ModeRecord& change : news.mode_changes) ecu_.change(change);
  return news;
}

void Watch::attach(News& news) {
  hal::linux_host::Reason reason;
  if (!memory_.open(name_.c_str(), kLayout, reason)) {
    absence_ = reason.text;
    return;
  }
  if (memory_.abandoned()) {
    memory_.close();
    absence_ = "the ECU has ended";
    return;
  }
  std::fill(std::begin(seen_), std::end(seen_), 0U);
  cycle_known_ = false;
  plan_ = {};
  ecu_ = {};
  control_ = {};
  status_ = {};
  looks_ = 1;
  news.another_ecu = true;
}

template <class Record>
bool Watch::take(Stream stream, Record& record) {
  const std::uint64_t number = memory_.newest(stream);
  if (number == seen_[stream]) return false;
  Record fresh;
  if (!memory_.read(stream, number, &fresh))
    return false;  // overtaken just now; the next look has a newer one
  record = fresh;
  seen_[stream] = number;
  return true;
}

bool Watch::find_cycle() {
  const std::uint64_t last = memory_.newest(kCycle);
  for (std::uint64_t number = last; number > 0 && last - number + 1 < kStreams[kCycle].slots; --number) {
    if (!memory_.read(kCycle, number, &cycle_)) return false;
    if (cycle_.scene.time_ms == plan_.computed_ms) return true;
  }
  return false;
}

campaign::CycleTrace trace_of(const ecu::PlanRecord& plan, const CycleRecord* cycle,
                              const campaign::EcuState& ecu) {
  campaign::CycleTrace trace;
  trace.record = plan;
  trace.ecu = ecu;
  trace.risk = plan.explanation.risk;
  if (cycle == nullptr) return trace;
  for (const scene::Agent& agent : cycle->scene.agents) trace.tracks.push_back(agent.track);
  trace.predictions.assign(cycle->prediction.agents.begin(), cycle->prediction.agents.end());
  return trace;
}

}  // namespace s4tp::telemetry
